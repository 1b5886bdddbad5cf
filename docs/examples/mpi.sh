#!/usr/bin/env bash
# A sweep whose ranks share the configurations; rank 0 writes. For a program that was built with
# cmake --preset release -DDEFINITE_MPI=ON
set -euo pipefail  # arguments go to the sweep, such as --kernels
definite=${DEFINITE:-build/release/definite} count=${COUNT:-1e9}
mpirun -n "${RANKS:-4}" ${MPI_OPTIONS-} "$definite" sweep "$@" --count "$count" --threads 1 \
  --json whole.json
