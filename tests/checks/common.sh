# Shared by the checks: where things are. Sourced, not run.
set -uo pipefail
root=${SCREE_SOURCE_DIR:-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
build=${SCREE_BUILD_DIR:-$root/build/release}
cd "$root" || exit 1
# what a killed run has left goes first
scratch=$build/scratch/$(basename "$0" .sh)
rm -rf "$scratch"
mkdir -p "$scratch" || exit 1
trap 'rm -rf "$scratch"' EXIT

# Sources of the named kinds (file name patterns), wherever scree keeps sources.
sources() {
    local folder patterns=() pattern
    for pattern in "$@"; do patterns+=(-o -name "$pattern"); done
    for folder in include src tests benchmarks examples tools validation; do
        [ -d "$folder" ] && find "$folder" -type f \( "${patterns[@]:1}" \)
    done | LC_ALL=C sort
}

# Closes a check: its name, how many things it looked at, and the file with one line per fault.
finish() {
    local what=$1 num=$2 faults=$3
    if [ "$num" -eq 0 ]; then
        echo "$what: nothing to check was found"
        exit 1
    fi
    if [ -s "$faults" ]; then
        cat "$faults"
        exit 1
    fi
    echo "$what: $num checked"
    exit 0
}
