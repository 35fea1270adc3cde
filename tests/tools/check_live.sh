#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_live.sh: the tests of tests/live, by the Python of the system, for which Debian's selenium
# is. What is missing is told, and skipped.
set -u

cd "$(dirname "$0")/../live" || exit 1
python=/usr/bin/python3
if ! command -v "$python" >/dev/null; then
    echo "check-live: SKIPPED: $python is missing"
    exit 0
fi
if ! "$MESOFIT" live --port 0 2>&1 | grep -q '1 to 65535'; then
    echo "check-live: this program has no command live"
    exit 1
fi
address=$(timeout 2 "$MESOFIT" live 2>&1 </dev/null)
case $address in
*"built without the live view"*)
    echo "check-live: SKIPPED: $address"
    exit 0
    ;;
esac
exec "$python" -W ignore::ResourceWarning -m unittest -v test_same_bits test_changes test_damping test_steering test_numbers test_progress test_particles test_panels test_views test_live
