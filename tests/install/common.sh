# Sourced by the install tests: SOURCE, BUILD and an empty WORK folder in which they run.
set -euo pipefail
SOURCE=$1 BUILD=$2 WORK=$3
rm -rf "$WORK"
mkdir -p "$WORK"
cd "$WORK"
# A stranger's environment: nothing of this build can be found by chance.
unset LD_LIBRARY_PATH LD_PRELOAD CMAKE_PREFIX_PATH PKG_CONFIG_PATH
umask 022

fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }

# expect TEXT COMMAND…: runs the command, which must succeed and say TEXT.
expect() {
    local text=$1 output
    shift
    output=$("$@" 2>&1) || fail "'$*' ended with $?: $output"
    printf '%s\n' "$output"
    grep -qF -- "$text" <<<"$output" || fail "'$*' does not say '$text'"
}
