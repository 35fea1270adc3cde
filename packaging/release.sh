#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# release.sh: what is committed, as source archive, wheel, Python's source archive and Debian packages, in
# build/release/VERSION. Each is made of the source archive, installed in a folder of its own, and
# passes smoke.sh there. Of a commit without its release's tag it is a rehearsal, and named after the commit. Debian:
# debhelper, dh-python, lintian, twine, python3-venv, beside what builds.
set -eu
cd "$(dirname "$0")/.."

[ -z "$(git status --porcelain)" ] || { echo "release: the tree has changes that are not committed" >&2; exit 1; }
version=$(src/base/version.sh)
made=$(pwd)/build/release/$version
python=${PYTHON:-/usr/bin/python3}
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
rm -rf "$made"
mkdir -p "$made/python"

step() {
    echo "== $version: $*"
}

step source archive
name=mesofit-$version
git archive --prefix="$name/" --add-virtual-file="$name/version:$version" --output="$made/$name.tar.gz" HEAD
tar -xzf "$made/$name.tar.gz" -C "$place"
cd "$place/$name"
make -j"$(nproc)" install PREFIX="$place/from-source" >/dev/null
PATH=$place/from-source/bin:$PATH packaging/smoke.sh "$version"

step wheel and archive of Python
"$python" -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir "$made" ./python
(cd python && "$python" -c 'import backend, sys; backend.build_sdist(sys.argv[1])' "$made/python")
packaging/check_wheel.py "$made"/*.whl
twine check --strict "$made"/*.whl "$made"/python/*.tar.gz
"$python" -m venv --system-site-packages "$place/venv"
"$place/venv/bin/pip" install --quiet --no-index --no-deps "$made"/*.whl
PATH=$place/venv/bin:$PATH packaging/smoke.sh "$version" "$place/venv/bin/python3"

step Debian packages
mkdir "$place/debian"
tar -xzf "$made/$name.tar.gz" -C "$place/debian"
cd "$place/debian/$name"
sed -i "1s/([^)]*)/($version)/" debian/changelog
dpkg-buildpackage --unsigned-source --unsigned-changes --build=binary >"$made/debian.log" 2>&1 || { tail -n 20 "$made/debian.log"; exit 1; }
lintian --fail-on error,warning ../*.changes
mkdir "$made/debian"
cp ../*.deb ../*.changes ../*.buildinfo "$made/debian"
for package in "$made"/debian/*.deb; do
    [ "$(dpkg-deb --field "$package" Version)" = "$version" ] || { echo "$package is of another version"; exit 1; }
    dpkg-deb --extract "$package" "$place/root"
done
libraries=$(dirname "$(find "$place/root" -name 'libmesofit.so.0')")
PATH=$place/root/usr/bin:$PATH LD_LIBRARY_PATH=$libraries PYTHONPATH=$place/root/usr/lib/python3/dist-packages \
    packaging/smoke.sh "$version" "$python"

cd "$made"
find . -type f ! -name SHA256SUMS -print0 | sort -z | xargs -0 sha256sum >SHA256SUMS
step "all of it is in $made"
case $version in *+*) echo "A rehearsal: the commit has no tag v${version%%+*}, or other commits followed." ;; esac
