#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# version.sh: what this source calls itself: the release of include/mesofit.h, "0.3.0", and in a clone what
# was done since its tag, "0.3.0+12.g1bc3e15", with ".dirty" if files were changed after that commit; without the
# tag "0.3.0+g1bc3e15". The file `version` says it in an archive that was made between releases. All of
# them are versions of Python (PEP 440), too.
set -eu
cd "$(dirname "$0")/../.."

release=$(sed -n 's/^#define MESOFIT_VERSION "\(.*\)"/\1/p' include/mesofit.h)
if [ -e version ]; then
    cat version
elif [ ! -e .git ]; then
    echo "$release"
# Root installs what another has cloned: Git would not look into that folder.
elif commit=$(git -c safe.directory='*' describe --always --tags --match "v$release" --dirty=.dirty 2>/dev/null); then
    echo "$commit" | sed -e "s/^v$release\$/$release/;t" -e "s/^v$release-\([0-9]*\)-g/$release+\1.g/;t" \
        -e "s/^v$release\./$release+/;t" -e "s/^/$release+g/"
else
    echo "$release+unknown"
fi
