#!/bin/sh
# Runs one shard of a sweep{{ usage }}. Written by carrystep {{ version }}.
#
# The shard keeps its progress in a file. If it is killed, start it again: it continues with the
# cases that are missing. If it is finished, it ends at once. The exit status is 0 if all cases of
# the shard have been judged, whatever the result; the merge gives the verdict.
set -u
number={{ number }}
# One thread, unless the scheduler gives more.
export RAYON_NUM_THREADS="${RAYON_NUM_THREADS:-1}"
exec {{ carrystep | sh }} sweep {{ file | sh }} {{ options }} --shard "$number/{{ shards }}" --keep {{ folder | sh }}/"shard-$number.kept" --no-verdict
