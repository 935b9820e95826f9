#!/bin/sh
# Runs a target, or all, with libFuzzer on a stable compiler:
# fuzz/stable.sh <target|all> [seconds | --inputs NUMBER]
set -eu
cd "$(dirname "$0")"
target=${1:?a target: urdf, xacro, mjcf, mjcf_grammar, sdf, scene, dynamics, macro_input or all}
if [ "${2:-}" = --inputs ]; then end="-runs=${3:?a number of inputs}"; else end="-max_total_time=${2:-60}"; fi
if [ "$target" = all ]; then
    shift
    for one in urdf xacro mjcf mjcf_grammar sdf scene dynamics macro_input; do ./stable.sh "$one" "$@"; done
    exit
fi
case $target in
    urdf) seeds="../models/urdf ../tests/ui/urdf" limits="-timeout=10 -rss_limit_mb=512" ;;
    xacro) seeds="../tests/xacro/models" limits="-timeout=10 -rss_limit_mb=512" ;;
    mjcf) seeds="../formats/tests/corpus/mjcf" limits="-timeout=10 -rss_limit_mb=512" ;;
    mjcf_grammar) seeds="" limits="-timeout=10 -rss_limit_mb=512" ;;
    sdf) seeds="../tests/sdf/models" limits="-timeout=10 -rss_limit_mb=512" ;;
    scene) seeds="../models/scenes ../tests/ui/scenes" limits="-timeout=10 -rss_limit_mb=1024" ;;
    dynamics) seeds="../models/urdf" limits="-timeout=20 -rss_limit_mb=2048" ;;
    macro_input) seeds="seeds/macro_input" limits="-timeout=20 -rss_limit_mb=2048" ;;
    *) echo "found $target, expected urdf, xacro, mjcf, mjcf_grammar, sdf, scene, dynamics, macro_input or all" >&2; exit 2 ;;
esac
host=$(rustc -vV | sed -n 's/^host: //p')
pass="-Cllvm-args=-sanitizer-coverage"
# With a target named, build scripts and macros are not instrumented.
RUSTFLAGS="-Cpasses=sancov-module $pass-level=4 $pass-inline-8bit-counters $pass-pc-table $pass-trace-compares -Ccodegen-units=1 -Cdebug-assertions -Coverflow-checks --cfg fuzzing" \
    cargo build --release --target "$host" --bin "$target"
mkdir -p "corpus/$target" "artifacts/$target"
# shellcheck disable=SC2086
exec "${CARGO_TARGET_DIR:-target}/$host/release/$target" "corpus/$target" $seeds $limits "$end" -artifact_prefix="artifacts/$target/"
