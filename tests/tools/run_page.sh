#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run_page.sh PAGE.md: does what a page tells its reader to, in the present folder. Blocks of code that
# are called "json FILE" are written to that file, those called "sh" are run, one after the other, and
# others are only read. It ends with the status of the first command that fails.
set -eu
export LC_ALL=C.UTF-8

awk '
    /^```/ && inside { if (inside == "json") print "END_OF_FILE"; inside = ""; next }
    /^```sh$/ { inside = "sh"; next }
    /^```json ./ { inside = "json"; print "cat >\"" $2 "\" <<\"END_OF_FILE\""; next }
    /^```/ { inside = "text"; next }
    inside == "sh" || inside == "json"' "$1" >page.sh
sh -eu page.sh
