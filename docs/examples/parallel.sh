#!/usr/bin/env bash
# A sweep shared out by GNU parallel: twelve parts, as many at a time as there are cores. Run it
# again after a power cut: parts go on where they were.
set -euo pipefail  # arguments go to the sweep, such as --kernels
definite=${DEFINITE:-build/release/definite} count=${COUNT:-1e9}
parallel --halt now,fail=1 "$definite" sweep "$@" --count "$count" --no-timing --threads 1 \
  --shard {}/12 --resume --json part-{}.json '>' /dev/null ::: $(seq 12)
"$definite" merge part-*.json --json whole.json
