cd /work/main
T="$@"; args=""; for t in $T; do args="$args --test $t"; done
CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_INCREMENTAL=1 cargo test --release --features internals $args --no-run --target-dir /tmp/relfast > /tmp/bt3.build 2>&1; grep -E "^(error|warning)" -A7 /tmp/bt3.build | head -40
for t in $T; do e=$(grep -oE "/tmp/relfast/release/deps/${t}-[0-9a-f]+" /tmp/bt3.build | tail -1); s=$(date +%s); CI=true CARGO_MANIFEST_DIR=/work/main CARGO_TARGET_TMPDIR=/tmp/tmpd timeout 580 $e $F > /tmp/bt3.$t.out 2>&1; echo "$t rc $? $(( $(date +%s)-s )) s; $(grep 'test result' /tmp/bt3.$t.out)"; done
