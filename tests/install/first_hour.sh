#!/usr/bin/env bash
# From clone to an axis of one's own that moves, in ten commands or fewer.
#   first_hour.sh SOURCE BUILD WORK           takes BUILD for what commands 1 to 3 would make
#   first_hour.sh SOURCE BUILD WORK --clone   clones and builds as well
. "$(dirname "$0")/common.sh"

count=0
# Each step is one command line that the user types.
step() {
    count=$((count + 1))
    printf '\n%2d $ %s\n' "$count" "$*"
    [ -n "${skip:-}" ] || eval "$*"
}

[ "${4:-}" = --clone ] || skip=yes
step git clone -q "$SOURCE" takt
step "(cd takt && cmake --preset release -DTAKT_TESTS=OFF)"
step "(cd takt && cmake --build --preset release)"
skip=
if [ -e takt ]; then BUILD=$WORK/takt/build/release; fi
step cmake --install '"$BUILD"' --prefix '"$WORK/prefix"' '>install.log'
step 'export PATH="$WORK/prefix/bin:$PATH"'
step takt new mine
step "sed -i 's/There = 100.0/There = 150.0/' mine/mine.cpp"
step "cmake -S mine -B mine/build && cmake --build mine/build"
step "takt run mine/machine.xml --sim --fast --trace mine.csv --plot mine.svg"

[ "$count" -le 10 ] || fail "it took $count commands"
[ "$(command -v takt)" = "$WORK/prefix/bin/takt" ] || fail "another takt was used"
# The axis went where the edit says, and nowhere beyond.
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "X.actual") at = i; next }
         $at > far { far = $at }
         END { exit !(far > 149.9 && far < 150.5) }' mine.csv || fail "the axis did not go to 150 mm"
# The project's own tests see the same, and a second project is not written over the first.
(cd mine/build && ctest --output-on-failure) || fail "the project's own tests"
if takt new mine 2>refusal.txt; then fail "a folder that is not empty was taken"; fi
grep -q 'not empty' refusal.txt || fail "the refusal does not say why"
printf '\n%s commands\n' "$count"
