# SPDX-License-Identifier: GPL-3.0-or-later
#
# docker build -t mesofit .
# docker run --rm --user "$(id -u):$(id -g)" --volume "$PWD:/work" mesofit fit run.json
# docker run … --entrypoint python3 mesofit analysis.py

FROM debian:12 AS build
RUN apt-get update && apt-get install -y --no-install-recommends build-essential pkg-config libgsl-dev libnlopt-dev \
    libcjson-dev librandom123-dev libhdf5-dev libzstd-dev libexpat1-dev libmicrohttpd-dev libjs-chart.js
COPY . /source
WORKDIR /source
RUN make -j"$(nproc)" && make install DESTDIR=/image PREFIX=/usr/local

FROM debian:12
RUN apt-get update && apt-get install -y --no-install-recommends gnuplot-nox libgsl27 libnlopt0 libcjson1 libgomp1 \
    libhdf5-103-1 libexpat1 libmicrohttpd12 python3-numpy python3-matplotlib && rm -rf /var/lib/apt/lists/*
COPY --from=build /image/ /
COPY python/mesofit /usr/local/lib/python3.11/dist-packages/mesofit
RUN ldconfig && mesofit --version && python3 -c "import mesofit"
WORKDIR /work
ENTRYPOINT ["mesofit"]
