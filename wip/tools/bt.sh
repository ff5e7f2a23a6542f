export CARGO_MANIFEST_DIR=/work/main CARGO_TARGET_TMPDIR=/tmp/tmpd
cd /work/main
CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_INCREMENTAL=1 timeout 590 cargo test --release --features internals --test gap --no-run --target-dir /tmp/relfast 2>&1 | grep -E "^error|warning: unused" ; $(ls -t /tmp/relfast/release/deps/gap-* | grep -v '\.d$'| head -1) power 2>&1 | grep -E "^test .*FAILED|test result"
