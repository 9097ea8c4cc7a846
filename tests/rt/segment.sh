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
# change_machine EXPRESSION…: works on a changed copy of the machine file
change_machine() {
    local expressions=() expression
    for expression; do expressions+=(-e "$expression"); done
    sed "${expressions[@]}" -e "s|file=\"../../|file=\"$(dirname "$machine")/../../|" "$machine" > machine.xml
    cmp -s machine.xml "$machine" && { echo "the machine file has nothing to change"; exit 1; }
    machine=$work/machine.xml
}
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
run_manual() {
    LD_PRELOAD=${TAKT_TRAP:-} $as "$takt" run "$machine" --interface bus0 --manual "$@"
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
network_file)
    far_sim "$6"
    LD_PRELOAD=${TAKT_TRAP:-} "$takt" run "$7" --interface bus0
    echo "run exit $?"
    end_sim
    ;;
long_line)
    machine=$6
    far_sim
    run two_moves --trace trace.csv
    end_sim
    ;;
hangs)
    far_sim
    run hangs --trace trace.csv
    end_sim
    ;;
interrupt)
    # PHASE COUNT: the program raises so many signals in that phase of its motion
    [ "$6" != homing ] || change_machine 's/method="35"/method="17" switchSpeed="20 mm\/s" zeroSpeed="5 mm\/s"/' \
        's/<Mechanics start="0 mm" inertia="3 kg cm^2"\/>/<Mechanics start="0 mm"><NegativeLimit to="-200 mm"\/><\/Mechanics>/'
    far_sim
    export TAKT_TEST_PHASE=$6 TAKT_TEST_COUNT=$7
    run signals --trace trace.csv --for 30s
    end_sim
    ;;
interrupt_start)
    far_sim
    run to_and_fro > run.out 2>&1 &
    controller=$!
    await run.out 'interface bus0' "$controller"
    pkill -INT -P $controller -x takt
    wait "$controller"
    cat run.out
    end_sim
    ;;
stalled)
    # ATTRIBUTES: of <Realtime>. While an axis moves to and fro, the controller is kept from running for a while.
    change_machine "s/overruns=\"count\"/$6/"
    far_sim
    for ((cycle = 50; cycle < 10000; cycle += 10)); do
        echo "$cycle heartbeat"
        ((cycle % 100 != 50)) || echo "$cycle power-on X"
        ((cycle % 200 != 60)) || echo "$cycle inch X 60 100"
        ((cycle % 200 != 160)) || echo "$cycle inch X -60 100"
    done > commands.txt
    run_manual --commands commands.txt --trace trace.csv > run.out 2>&1 &
    controller=$!
    await sim.out 'x: OP, drive Operation enabled'
    sleep 0.7
    pkill -STOP -P "$controller" -x takt
    sleep 0.6
    pkill -CONT -P "$controller" -x takt
    # Where it only counts it goes on until it is told to stop.
    [[ $6 == *react* ]] || { sleep 0.5 && pkill -INT -P "$controller" -x takt; }
    wait "$controller"
    cat run.out
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
        # Traced and on a computer with other things to do, more frames may be late than are tolerated: then once more.
        for _ in 1 2 3 4 5 6; do
            strace -f -o calls.$length "$takt" run "$machine" --interface bus0 \
                --program "$programs/to_and_fro.so" --for $length > run.out 2>&1
            code=$?
            [ $code -ne 0 ] || break
            sed 's/^/once more: /' run.out
        done
        echo "run exit $code"
        cat run.out
    done
    end_sim > /dev/null
    ;;
*)
    echo "no scenario '$scenario'"
    exit 1
    ;;
esac
