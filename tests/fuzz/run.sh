#!/usr/bin/env bash
# Fuzzes the readers (of designs, drawings, tile sets, sets of words, manifests of sweeps, tables, starts
# and parts of tables), fits to gaps, the energies' bounds over cells and whole analyses, for the given number of seconds each [20], starting from the
# shipped files, the tests' files and earlier findings (cases/). With `same` instead of the seconds a
# fixed sequence of a few thousand inputs is tried. A finding is written to target/fuzz/found; move it
# to cases/, which ordinary tests replay: they contain all of src/lib.rs. Names of targets after the
# seconds select these targets. Skips if the fuzzer cannot be built.
set -euo pipefail
cd "$(dirname "$0")"
effort="${1:-20}"
targets=("${@:2}")
((${#targets[@]})) || targets=(design drawing tileset words plan table start part gaps bounds analyse)
root=../..
export CARGO_TARGET_DIR="$PWD/$root/target/fuzz"

skip() {
    echo "fuzz: skipped ($1)"
    exit 0
}
[[ "$(uname -sm)" == "Linux x86_64" ]] || skip "needs Linux on x86-64"
command -v g++ >/dev/null || skip "needs g++"
cargo fetch --quiet 2>/dev/null || skip "libfuzzer-sys cannot be fetched"
cargo build --release --quiet

declare -A seeds=(
    [design]="$root/shapes $root/tests/designs/good $root/tests/designs/bad"
    [drawing]="$root/shapes $root/tests/designs/drawings"
    [tileset]="$root/shapes/assemblies"
    [words]="$root/shapes"
    [plan]=""
    [table]=""
    [start]="cases/table"
    [part]=""
    [gaps]=""
    [bounds]=""
    [analyse]=""
)
# As many as end in about ten seconds.
declare -A inputs=(
    [design]=15000 [drawing]=20000 [tileset]=40000 [words]=10000 [plan]=60000 [table]=1000
    [start]=20000 [part]=20000 [gaps]=2000 [bounds]=200 [analyse]=20
)
try() {
    local target="$1" limit options cases=() executed
    local grown="$CARGO_TARGET_DIR/corpus/$target" found="$CARGO_TARGET_DIR/found/$target"
    if [[ "$effort" == same ]]; then
        rm -rf "$grown"
        limit=(-seed=1 -runs="${inputs[$target]}")
    else
        limit=(-max_total_time="$effort")
    fi
    mkdir -p "$grown" "$found"
    options=("${limit[@]}" -timeout=20 -rss_limit_mb=2048 -max_len=32768
        -artifact_prefix="$found/" -print_final_stats=1)
    [[ -f "$target.dict" ]] && options+=(-dict="$target.dict")
    [[ -d "cases/$target" ]] && cases=("cases/$target")
    # shellcheck disable=SC2086 # folders without spaces
    if ! "$CARGO_TARGET_DIR/x86_64-unknown-linux-gnu/release/$target" "${options[@]}" \
        "$grown" "${cases[@]}" ${seeds[$target]} 2>"$found/log"; then
        tail -n 40 "$found/log"
        echo "fuzz: a finding in $target: see $found"
        return 1
    fi
    executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$found/log")
    echo "fuzz: $target: $executed inputs, no finding"
}

# One target a core.
running=0 failed=0
finish_one() {
    wait -n || failed=1
    running=$((running - 1))
}
for target in "${targets[@]}"; do
    ((running < $(nproc))) || finish_one
    try "$target" &
    running=$((running + 1))
done
while ((running)); do finish_one; done
exit "$failed"
