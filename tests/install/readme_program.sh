#!/usr/bin/env bash
# The program of the README, built against an installed takt with find_package and with pkg-config, runs on the
# simulated machine; both do the same in every cycle.
. "$(dirname "$0")/common.sh"

cmake --install "$BUILD" --prefix "$WORK/prefix" >install.log
takt=$WORK/prefix/bin/takt
awk '/^```cpp$/ { inside = 1; next } /^```$/ { if (inside) exit } inside' "$SOURCE/README.md" >readme.cpp
grep -q TAKT_PROGRAM readme.cpp || fail "the README has no program"

# A prefix is a folder like any other: it can be moved.
mv prefix moved
takt=$WORK/moved/bin/takt
expect "takt " "$takt" --version
expect "X (CD300E)" "$takt" new machine

mkdir found
cat >found/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.20)
project(found LANGUAGES CXX)
find_package(takt 0.1 REQUIRED)
takt_program(found ../readme.cpp)
END
cmake -S found -B found/build -DCMAKE_PREFIX_PATH="$WORK/moved" >configure.log || { cat configure.log; fail "find_package"; }
cmake --build found/build >build.log 2>&1 || { cat build.log; fail "building with find_package"; }

export PKG_CONFIG_PATH=$WORK/moved/lib/pkgconfig
[ "$(pkg-config --modversion takt)" = "$("$takt" --version | cut -d' ' -f2)" ] || fail "versions differ"
# shellcheck disable=SC2046
g++ -O2 -ffp-contract=off -fPIC -shared readme.cpp -o libconfigured.so $(pkg-config --cflags --libs takt)

for library in found/build/libfound.so libconfigured.so; do
    expect finished "$takt" run machine/machine.xml --fast --program "$library" --trace "$(basename "$library").csv"
done
cmp libfound.so.csv libconfigured.so.csv || fail "the two builds move the axis differently"
grep -q DiscreteMotion libfound.so.csv || fail "the axis did not move"

# The unit file is good: systemd looks for the command where packages put it, so it is shown the one here.
if command -v systemd-analyze >/dev/null; then
    mkdir unit
    sed "s|ExecStart=takt|ExecStart=$takt|" moved/lib/systemd/system/takt@.service >unit/takt@machine.service
    expect "" systemd-analyze verify unit/takt@machine.service
    # Its command line, with the settings as they are delivered, refuses to start.
    eval "$(grep -v '^#' moved/share/takt/takt.default)"
    code=0
    said=$("$takt" run machine/machine.xml --interface "$TAKT_INTERFACE" --quiet $TAKT_OPTIONS 2>&1) || code=$?
    [ "$code" -eq 1 ] || fail "without an interface the service would end with $code: $said"
    said=$(systemd-analyze verify unit/takt@machine.service 2>&1) || true
    [ -z "$said" ] || fail "systemd says: $said"
fi
