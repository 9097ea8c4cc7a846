#!/usr/bin/env bash
# The bus tools on a network interface: one end of a veth pair, the simulated gantry on the other one. States,
# identities and values are asserted, never times.
#   interface_tools.sh TAKT MACHINE WORK
set -euo pipefail
if [ "${4:-}" != inside ]; then
    unshare -Urn true 2>/dev/null || {
        echo "FAILED: this system forbids network namespaces for users. Allow them:"
        echo "  sysctl kernel.unprivileged_userns_clone=1 (Debian) and, in a container, seccomp and CAP_SYS_ADMIN"
        exit 1
    }
    exec unshare -Urn bash "$0" "$1" "$2" "$3" inside
fi
takt=$1 machine=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"

fail() { echo "FAILED: $*" >&2; exit 1; }
# says TEXT COMMAND…: succeeds and says TEXT
says() {
    local text=$1 output
    shift
    output=$("$takt" "$@" --interface eth_master 2>&1) || fail "takt $*: $output"
    grep -qF -- "$text" <<<"$output" || fail "takt $* does not say '$text': $output"
}
# refuses TEXT COMMAND…: ends with 2 and one line with TEXT
refuses() {
    local text=$1 output code=0
    shift
    output=$("$takt" "$@" --interface eth_master 2>&1) || code=$?
    [ "$code" -eq 2 ] || fail "takt $* ended with $code: $output"
    [ "$(wc -l <<<"$output")" -eq 1 ] || fail "takt $* says more than one line: $output"
    grep -qF -- "$text" <<<"$output" || fail "takt $* does not say '$text': $output"
}

ip link add eth_master type veth peer name eth_segment
refuses "is down" scan
ip link set eth_master up
ip link set eth_segment up
refuses "no device answers" scan

"$takt" sim "$machine" --interface eth_segment --quiet &
sim=$!
trap 'kill $sim 2>/dev/null || true' EXIT
for _ in $(seq 100); do
    "$takt" slaves --interface eth_master >/dev/null 2>&1 && break
done

says "0xFFFF0A5E  0x000A2000  0x00000101" scan
says '"pos":2,"name":"","type":"RA"' scan --json
says "INIT" slaves
says "2  RA                PREOP" states PREOP
says "-196608" upload 2 0x6064
says "1234" download 0 0x6065 1234
says "1234  0x000004D2" upload 0 0x6065
refuses "0x06020000 object does not exist" upload 1 0x9999
says "0  CD300E            INIT" states INIT

"$takt" new scanned --scan eth_master >new.txt || fail "takt new --scan: $(cat new.txt)"
grep -q 'X (CD300E), Y (CD300E), Z (RA)' new.txt || fail "takt new --scan: $(cat new.txt)"
grep -q 'interface="eth_master"' scanned/machine.xml || fail "the interface is not in the machine file"
"$takt" run scanned/machine.xml --fast --manual --for 100ms >run.txt 2>&1 || fail "the scanned machine: $(cat run.txt)"
echo "all as expected"
