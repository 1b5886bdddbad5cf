#!/usr/bin/env bash
#SBATCH --array=1-100
#SBATCH --cpus-per-task=8
#SBATCH --requeue
# A sweep shared out over a Slurm array: sbatch slurm-array.sh; then, when all are done,
# definite merge part-*.json --json whole.json
set -euo pipefail  # arguments go to the sweep, such as --kernels
definite=${DEFINITE:-build/release/definite} count=${COUNT:-1e10}
"$definite" sweep "$@" --count "$count" --no-timing --threads "${SLURM_CPUS_PER_TASK:-1}" \
  --shard auto --resume --json "part-$SLURM_ARRAY_TASK_ID.json"
