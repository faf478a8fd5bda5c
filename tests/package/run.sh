#!/usr/bin/env bash
# The packages: eight crates for cargo, and a source distribution for pip.
#
#     tests/package/run.sh            packs all of it; checks what is in it and how large it is
#     tests/package/run.sh install    also installs the program and the Python package from what was
#                                     packed, away from the checkout, and runs both (a whole build)
#
# The source distribution needs Python 3.11 and maturin; without them that part is skipped.
set -euo pipefail
cd "$(dirname "$0")/../.."
fail() {
    echo "package: $1" >&2
    exit 1
}

export CARGO_TARGET_DIR="$PWD/target"
packed=$CARGO_TARGET_DIR/package
rm -rf "$packed"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cargo package --workspace --exclude tilebind-python --no-verify --allow-dirty >"$scratch/log" 2>&1 ||
    { cat "$scratch/log"; exit 1; }
for crate in "$packed"/*.crate; do tar xzf "$crate" -C "$scratch"; done
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
program=$scratch/tilebind-$version
[ -f "$program/src/main.rs" ] || fail "there is no package of version $version"

# Every source and every design is in some package, and nothing that only the repository needs.
for crate in tiles landscape shaken words physics jobs report; do
    (cd "$scratch/tilebind-$crate-$version" && find . -type f -printf "src/$crate/%P\n")
done >"$scratch/found"
(cd "$program" && find . -type f -printf '%P\n') >>"$scratch/found"
grep -v '\(^\|/\)\(Cargo.lock\|Cargo.toml.orig\|.cargo_vcs_info.json\)$' "$scratch/found" | sort >"$scratch/is"
git ls-files Cargo.toml LICENSE README.md results/paper-tile/map.png shapes src ':!src/python' |
    sort >"$scratch/wanted"
diff "$scratch/wanted" "$scratch/is" || fail "the packages hold other files (<: missing, >: too many)"
size() { cat "$@" | wc -c; }
total=$(size "$packed"/*.crate)
echo "package: eight crates of version $version, $((total / 1000)) kB"
[ "$total" -le 2000000 ] || fail "the crates are larger than 2 MB"

python=$CARGO_TARGET_DIR/python/venv/bin/python
if [ ! -x "${python%python}maturin" ]; then
    python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' &&
        python3 -m venv "$CARGO_TARGET_DIR/python/venv" &&
        "$python" -m pip --quiet --disable-pip-version-check install --retries 2 'maturin>=1.9,<2' ||
        python=
fi
if [ -n "$python" ]; then
    "${python%python}maturin" sdist --out "$packed" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
    source=$packed/tilebind-$version.tar.gz
    echo "package: source distribution, $(($(size "$source") / 1000)) kB"
    [ "$(size "$source")" -le 2000000 ] || fail "the source distribution is larger than 2 MB"
else
    echo "package: no source distribution, maturin cannot be installed"
fi
[ "${1:-}" = install ] || exit 0

# The crates below the program's come from their packages, as they would from a registry.
export CARGO_TARGET_DIR=$packed/build
lower=()
for crate in tiles landscape shaken words physics jobs report; do
    lower+=(--config "patch.crates-io.tilebind-$crate.path='$scratch/tilebind-$crate-$version'")
done
sed -i '/^name = "tilebind-/,/^$/{/^\(source\|checksum\) /d}' "$program/Cargo.lock"
(cd "$scratch" && cargo install --quiet --locked --path "$program" --root "$scratch/installed" "${lower[@]}")
cd "$program"
"$scratch/installed/bin/tilebind" --version
"$scratch/installed/bin/tilebind" energy shapes/paper-tile.toml --pose 0.43,0,0 >"$scratch/energy.json"
echo "package: the program is installed from the crates"

[ -n "$python" ] || exit 0
"$python" -m venv "$scratch/venv"
"$scratch/venv/bin/pip" --quiet --disable-pip-version-check install "$source"
"$scratch/venv/bin/python" - "$scratch/energy.json" <<'PYTHON'
import json, sys, tilebind
design = tilebind.Design.load("shapes/paper-tile.toml")
energy = float(design.energy([[0.43, 0.0, 0.0]])[0])
assert energy == json.load(open(sys.argv[1]))[0]["energy_J"], energy
print("package: Python has", energy, "J at the bond, as the installed program has")
PYTHON
echo "package: the Python package is installed from the source distribution"
