#!/bin/sh
# Merges all shards of a sweep into report.json and prints the report. It refuses if a shard is
# missing or not finished. Written by carrystep {{ version }}.
set -u
# An earlier report must not be taken for this one.
rm -f {{ folder | sh }}/report.json
exec {{ carrystep | sh }} sweep --merge {{ folder | sh }}/shard-*.kept --report {{ folder | sh }}/report.json
