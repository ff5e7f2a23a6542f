#!/bin/bash
# world3.sh DIR OUT: diagnose all torque cases with the lab binary
rm -rf $2.d; mkdir -p $2.d
B=$2.d/bin; cp /work/wt/lab/target/release/lab $B
for c in $(ls -d $1/case*); do n=$(basename $c); if [ -f $c/truth.json ]; then grep -qE '"kind": *"(motion|power)"' $c/truth.json || echo $c; elif [ ! -f $c/main.mod ]; then echo $c; fi; done | xargs -P ${P:-2} -I{} sh -c 'timeout 200 '$B' {} 2>/dev/null > '$2.d'/$(basename {}).json'
cat $2.d/*.json > $2
