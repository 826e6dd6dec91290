#!/usr/bin/env bash
# Checks machines, moves and generated Verilog in $FOLDER. It fails if one of them fails, if a
# pattern matches no file, or if there is nothing to check.
set -euo pipefail
shopt -s nullglob globstar
cd "${FOLDER:-.}"
carrystep=${CARRYSTEP_COMMAND:-carrystep}
core=${CORE:-engine}
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
tried=0
failed=0

# result NAME COMMAND...: runs a command and counts how it ended.
result() {
    local name=$1
    shift
    tried=$((tried + 1))
    if "$@" > "$made/said" 2>&1; then
        echo "passed: $name"
    else
        failed=$((failed + 1))
        cat "$made/said"
        echo "::error::failed: $name"
    fi
}

# each PATTERNS COMMAND...: runs a command with each file that a pattern matches. PATTERNS has one
# pattern per line.
each() {
    local pattern file patterns=$1
    shift
    while IFS= read -r pattern; do
        [ -n "${pattern//[[:space:]]/}" ] || continue
        local IFS=
        # shellcheck disable=SC2206 # the pattern is meant to become files
        local files=($pattern)
        unset IFS
        [ "${#files[@]}" -gt 0 ] || result "$pattern" missing "$pattern"
        for file in "${files[@]}"; do
            result "$file" "$@" "$file"
        done
    done <<< "$patterns"
}

missing() {
    echo "no file matches $1"
    return 1
}

machine() {
    [ -f "$1" ] || missing "$1"
    "$carrystep" verilog --core "$core" --machine "$1" --out "$made/machine"
}

move() {
    "$carrystep" simulate --core "$core" "$1"
}

# verilog FOLDER MACHINE OPTIONS...: what is committed must be what is generated now.
verilog() {
    local committed=$1 machine=$2 file
    shift 2
    rm -rf "$made/verilog"
    "$carrystep" verilog --machine "$machine" --out "$made/verilog" "$@" || return 1
    while IFS= read -r -d '' file; do
        diff -u "$committed/$file" "$made/verilog/$file" || return 1
    done < <(cd "$made/verilog" && find . -type f -print0 | sort -z)
}

each "${MACHINES:-}" machine
each "${MOVES:-}" move
while read -r folder machine options; do
    [ -n "$folder" ] || continue
    read -r -a words <<< "$options"
    result "$folder" verilog "$folder" "$machine" "${words[@]}"
done <<< "${VERILOG:-}"

echo "$tried checked, $failed failed"
[ "$tried" -gt 0 ] || echo "::error::nothing to check: give machines, moves or verilog"
[ "$tried" -gt 0 ] && [ "$failed" -eq 0 ]
