#!/bin/bash
# run1.sh BIN CASE : text out
cd /tmp/gc/$2; a=$(sed 's/^diagnose //; s/--out OUT.toml//; s/--format json//' command.txt)
/usr/bin/time -f "%U user %e real %M KB" $1 diagnose $a --quiet ${@:3} 2>&1
