cd /work/wt/gap; export CARGO_TARGET_DIR=/work/main/target CARGO_PROFILE_DEV_DEBUG=0 CARGO_INCREMENTAL=0
cargo test --no-run > /tmp/build.log 2>&1; echo "rc $?" >> /tmp/build.log; date >> /tmp/build.log
