#!/usr/bin/env bash
# The folders of src are a tower: cli > io > dynamics > forces > contact > polyhedra > bvh > core. Includes point down.
. "$(dirname "$0")/common.sh"
: >"$scratch/faults"
mapfile -t files < <(find src -type f | LC_ALL=C sort)
awk '
BEGIN { num = split("core bvh polyhedra contact forces dynamics io cli", names, " ")
        for (i = 1; i <= num; ++i) floor[names[i]] = i }
{ split(FILENAME, path, "/") }
FNR == 1 && !(path[2] in floor) { print FILENAME ": " path[2] " is not a floor of the tower" }
match($0, /^[ \t]*#[ \t]*include[ \t]*"[^"\/]*\//) {
    part = $0; sub(/^[^"]*"/, "", part); sub(/\/.*/, "", part)
    if (part in floor && floor[part] > floor[path[2]]) print FILENAME ":" FNR ": includes upwards, " part
    if (!(part in floor) && part != "scree") print FILENAME ":" FNR ": includes from outside of src and include/scree"
}
match($0, /^[ \t]*#[ \t]*include[ \t]*"[^"\/]*"/) { print FILENAME ":" FNR ": includes without its folder" }
' "${files[@]}" >"$scratch/faults"
finish "includes of files" ${#files[@]} "$scratch/faults"
