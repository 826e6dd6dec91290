#!/bin/sh
# Runs the {{ shards }} shards of a sweep by GNU parallel, one on each core, and merges them. Written by
# carrystep {{ version }}.
#
# Options for GNU parallel can be given in the variable PARALLEL. For example, this uses two more
# machines that have this folder, the sweep file and carrystep under the same paths:
#
#   PARALLEL='--sshlogin :,one,other' sh run.sh
#
# If it is ended, or a shard fails, start it again: finished shards end at once, and the others
# continue where they stopped. The exit status is that of the merge.
set -u
command -v parallel > /dev/null || {
    echo 'GNU parallel is missing: install the package parallel' >&2
    exit 3
}
cd {{ folder | sh }} || exit 2
seq 1 {{ shards }} | parallel --joblog shards.joblog sh {{ (folder ~ "/shard.sh") | sh | sh }} {}
exec sh ./merge.sh
