#!/usr/bin/env bash
# segment.sh SCENARIO WORKFOLDER TAKT MACHINE PROGRAMFOLDER
# To be run inside fresh user and network namespaces (unshare -Urn). Makes a second network namespace with
# the other end of a veth pair in it: the simulated segment lives there, the controller here. Nothing here
# measures time; waiting is for events only, and whoever calls limits the whole.
set -u
scenario=$1 work=$2 takt=$3 machine=$4 programs=$5
cd "$work" || exit 1
trap 'kill -KILL $(jobs -p) 2>/dev/null' EXIT

# await FILE TEXT [PROCESS]: until the file has a line with that text; gives up when the process that should
# write it has ended without it
await() {
    until grep -q -e "$2" "$1" 2>/dev/null; do
        [ -z "${3:-}" ] || kill -0 "$3" 2>/dev/null || grep -q -e "$2" "$1" || {
            echo "ended without saying '$2':"
            cat "$1"
            exit 1
        }
        sleep 0.05
    done
}

# far_sim [MACHINE]: the simulated segment on the far end, output in sim.out
far_sim() {
    ip link add bus0 type veth peer name bus1 && ip link set bus0 up || exit 1
    mkfifo entered go
    unshare -n sh -c 'echo > entered; read line < go; ip link set bus1 up
        exec "$0" sim "$1" --interface bus1' "$takt" "${1:-$machine}" > sim.out 2>&1 &
    sim=$!
    read -r _ < entered
    ip link set bus1 netns "$sim" || exit 1
    echo > go
    await sim.out 'simulated devices on bus1' "$sim"
}
end_sim() { kill -TERM "$sim"; wait "$sim"; echo "sim exit $?"; sed 's/^/sim: /' sim.out; }
# tool VERB [OPTION…]: a bus tool on this end
tool() {
    $as "$takt" "$@" --interface bus0 > tool.out 2>&1
    local code=$?
    sed "s/^/$1: /" tool.out
    echo "$1 exit $code"
}
# run PROGRAM [OPTION…]: takt on this end; the trap library in front where there is one
run() {
    local program=$1
    shift
    LD_PRELOAD=${TAKT_TRAP:-} $as "$takt" run "$machine" --interface bus0 --program "$programs/$program.so" "$@"
    echo "run exit $?"
}
as=''  # the command in front that takes rights away
three_capabilities='setpriv --bounding-set=-all,+net_raw,+sys_nice,+ipc_lock'

case $scenario in
moves | moves_with_three_capabilities)
    far_sim
    [ "$scenario" = moves ] || as=$three_capabilities
    tool scan --json
    tool slaves --json
    tool states PREOP
    tool slaves
    tool states INIT
    run two_moves --trace trace.csv
    end_sim
    ;;
gives_up_capabilities)
    far_sim
    LD_PRELOAD=${TAKT_TRAP:-} $three_capabilities "$takt" run "$machine" --interface bus0 \
        --program "$programs/to_and_fro.so" > run.out 2>&1 &
    controller=$!
    await run.out 'network in OP' "$controller"
    for task in /proc/$controller/task/*; do
        echo "left over: $(grep -h -e CapPrm -e CapEff "$task/status" | tr '\n' ' ')"
    done
    kill -INT "$controller"
    wait "$controller"
    echo "run exit $?"
    cat run.out
    end_sim
    ;;
missing_capability)
    ip link add bus0 type veth peer name bus1 && ip link set bus0 up
    as='setpriv --bounding-set=-net_raw'
    run two_moves
    ;;
down)
    ip link add bus0 type veth peer name bus1
    run two_moves
    ;;
not_there)
    run two_moves
    ;;
owned)
    ip link add bus0 type veth peer name bus1 && ip link set bus0 up && ip link set bus1 up
    "$takt" sim "$machine" --interface bus0 > sim.out 2>&1 &
    sim=$!
    await sim.out 'simulated devices on bus0' "$sim"
    run two_moves
    end_sim
    ;;
other_machine)
    far_sim "$6"
    run two_moves
    end_sim
    ;;
hangs)
    far_sim
    run hangs --trace trace.csv
    end_sim
    ;;
killed)
    far_sim
    run to_and_fro > run.out 2>&1 &
    await sim.out 'x: OP, drive Operation enabled'
    pkill -KILL -P $! -x takt || kill -KILL $!
    await sim.out 'x: SAFEOP with error'
    end_sim
    ;;
system_calls)
    far_sim
    for length in 1s 3s; do
        strace -f -o calls.$length "$takt" run "$machine" --interface bus0 --program "$programs/to_and_fro.so" \
            --for $length
        echo "run exit $?"
    done
    end_sim > /dev/null
    ;;
*)
    echo "no scenario '$scenario'"
    exit 1
    ;;
esac
