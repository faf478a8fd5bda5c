#!/usr/bin/env bash
# Builds the wheel of the Python package and runs its tests in a venv of its own, which is kept in
# target/python for the next time:
#
#     tests/python/run.sh [PROFILE]
#
# Skips with a line where Python 3.11, venv, pip or a package cannot be had. The profile `quick`
# builds fastest; results do not depend on it.
set -euo pipefail
cd "$(dirname "$0")/../.."
profile=${1:-release}
venv=target/python/venv
wheels=target/python/wheels
skip() {
    echo "python: skipped, $1"
    exit 0
}

command -v python3 >/dev/null || skip "there is no python3"
python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' || skip "python3 is older than 3.11"
[ -x "$venv/bin/pip" ] || python3 -m venv "$venv" || skip "python3 cannot make a venv"
python="$venv/bin/python"
install=("$python" -m pip --quiet --disable-pip-version-check --no-input install --retries 2)
"${install[@]}" "maturin>=1.9,<2" || skip "maturin cannot be installed"

# What the extra `test` of pyproject.toml names comes while the wheel is built.
mapfile -t packages < <("$python" -c 'import tomllib
project = tomllib.load(open("pyproject.toml", "rb"))["project"]
print(*project["dependencies"], *project["optional-dependencies"]["test"], sep="\n")')
"${install[@]}" "${packages[@]}" &
packages_come=$!
rm -f "$wheels"/tilebind-*.whl
"$venv/bin/maturin" build --locked --profile "$profile" --interpreter "$python" --out "$wheels"
wait "$packages_come" || skip "the packages of the tests cannot be installed"

wheel=$(echo "$wheels"/tilebind-*.whl)
size=$(stat -c %s "$wheel")
echo "python: $(basename "$wheel"), $((size / 1000)) kB"
[ "$size" -le 12000000 ] || { echo "python: the wheel is larger than 12 MB"; exit 1; }
"${install[@]}" --force-reinstall --no-deps "$wheel"
"$python" -m pytest -q -p no:cacheprovider --durations=8 tests/python
