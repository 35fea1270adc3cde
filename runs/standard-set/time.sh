#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Where the processor time of fits went, as a table in Markdown.
#
# time.sh FOLDER...: folders that `mesofit fit` has written, each a row
set -eu
export LC_ALL=C.UTF-8
here=$(cd "$(dirname "$0")" && pwd)

echo "| fit | iterations | processor s | equilibration | samples | lost samples | algebra | rest | verification | figures | inefficiency | error | statistics alone | of ideal |"
echo "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
for folder; do
    name=${folder%/}
    name=$(basename "${name%/fit}")
    for file in timing.tsv history.tsv summary.json; do
        [ -e "$folder/$file" ] || { echo "time.sh: no $file in $folder: is it the folder of a fit that has ended?" >&2 && exit 2; }
    done
    awk -v name="$name" -f "$here/time.awk" "$folder/timing.tsv" "$folder/history.tsv" "$folder/summary.json"
done
