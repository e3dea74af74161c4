#!/bin/sh
# Measures an experiment on Slurm: an array of SHARDS tasks, and a job that joins them to the report in OUT/whole.
#   slurm.sh SHARDS OUT [EXPERIMENT] [OPTIONS OF 'shadowbench run']
# The working folder, OUT, the program and all files that are named must be the same on all nodes. sbatch takes its
# options from the environment, such as SBATCH_PARTITION, SBATCH_TIMELIMIT and SBATCH_ACCOUNT; SHADOWBENCH names another
# program. A task whose node is lost is queued again; the same command again measures what is left. Either way
# finished cells stay.
set -eu
if [ $# -lt 2 ]; then
  echo "usage: slurm.sh SHARDS OUT [EXPERIMENT] [OPTIONS OF 'shadowbench run']" >&2
  exit 2
fi
program=${SHADOWBENCH:-shadowbench} what=$1
case $what in
  task | merge) shards=$2 out=$3 && shift 3 ;;  # sbatch runs this script with its own words behind one of these
  *) shards=$1 out=$2 && shift 2 ;;
esac
case $what in
  task)
    exec "$program" run "$@" --yes --no-grids --cache "$out/cache" --shard "$SLURM_ARRAY_TASK_ID/$shards" \
      --out "$out/$SLURM_ARRAY_TASK_ID-of-$shards"
    ;;
  merge) exec "$program" merge "$out"/*"-of-$shards" --out "$out/whole" ;;
esac
mkdir -p "$out"
array=$(sbatch --parsable --array="1-$shards" --requeue --exclusive --open-mode=append --output="$out/task-%a.log" \
  "$0" task "$shards" "$out" "$@")
sbatch --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes --output="$out/merge.log" "$0" merge "$shards" "$out"
