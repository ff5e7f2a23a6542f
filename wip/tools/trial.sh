cd /tmp/fresh/main
export CI=true INSTA_UPDATE=no CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=0
s=$(date +%s); step(){ echo "== $* at $(( $(date +%s)-s ))"; "$@"; echo "rc $?"; }
step cargo fmt --check
step cargo clippy --locked --all-targets -- -D warnings
step cargo clippy --locked --lib --bins -- -D dead_code
RUSTDOCFLAGS="-D warnings" step cargo doc --locked --no-deps
step cargo test --workspace --no-fail-fast
step cargo test --locked --doc
echo "ALL $(( $(date +%s)-s ))"
