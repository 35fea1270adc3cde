#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Called by conda-build, which sets PREFIX, SP_DIR, CC and CPU_COUNT. Not run yet.
set -eu

export PKG_CONFIG_PATH="$PREFIX/lib/pkgconfig"
make -j"$CPU_COUNT" install PREFIX="$PREFIX" LDFLAGS="${LDFLAGS:-} -L$PREFIX/lib -Wl,-rpath,$PREFIX/lib"
install -d "$SP_DIR/mesofit"
install -m 644 python/mesofit/*.py python/mesofit/py.typed "$SP_DIR/mesofit"
(cd python && "$PYTHON" -c 'import backend, sys; backend.prepare_metadata_for_build_wheel(sys.argv[1])' "$SP_DIR")
