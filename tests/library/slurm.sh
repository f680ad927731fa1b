# A Slurm of its own for a test: `. slurm.sh`; start_slurm FOLDER NODES CPUS, kill_node N, stop_slurm. As root, without
# systemd. All its files are in FOLDER, whose path must be short (a socket's has 107 bytes); SLURM_CONF makes it that of
# every client.

free_ports() { # COUNT: that many neighbouring ports to which nobody listens: prints the first
  local first port
  for _ in $(seq 50); do
    first=$((20000 + RANDOM % 10000))
    for port in $(seq $first $((first + $1 - 1))); do
      ! (exec 3<>/dev/tcp/127.0.0.1/"$port") 2>/dev/null || continue 2
    done
    echo $first
    return
  done
  return 1
}

write_slurm_conf() { # FOLDER NODES CPUS
  local port host
  host=$(hostname -s)
  port=$(free_ports $(($2 + 1))) || return 1
  cat >"$1/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$1/munge/socket
CryptoType=crypto/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$1/state
SlurmdSpoolDir=$1/%n
SlurmctldPidFile=$1/slurmctld.pid
SlurmdPidFile=$1/%n.pid
SlurmctldLogFile=$1/slurmctld.log
SlurmdLogFile=$1/%n.log
JobCompType=jobcomp/filetxt
JobCompLoc=$1/jobs
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
SchedulerParameters=batch_sched_delay=1,sched_interval=5,bf_interval=5
SlurmdTimeout=10
MessageTimeout=5
KillWait=5
ReturnToService=2
NodeName=n[1-$2] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + $2))] CPUs=$3 RealMemory=512
PartitionName=all Nodes=n[1-$2] Default=YES MaxTime=INFINITE State=UP
CONF
}

start_slurm() { # FOLDER NODES CPUS: returns when all nodes take jobs
  slurm=$1
  slurm_nodes=$2
  mkdir -p "$slurm"/{munge,state} && chmod 700 "$slurm/munge" || return 1
  (umask 077 && head -c 128 /dev/urandom >"$slurm/munge/key" && chmod 400 "$slurm/munge/key") || return 1
  munged --force --key-file="$slurm/munge/key" --socket="$slurm/munge/socket" --pid-file="$slurm/munge/pid" \
    --log-file="$slurm/munge/log" --seed-file="$slurm/munge/seed" || return 1
  chmod 755 "$slurm/munge"
  write_slurm_conf "$@" || return 1
  export SLURM_CONF=$slurm/slurm.conf
  start_controller || return 1
  for node in $(seq "$slurm_nodes"); do start_node "$node" || return 1; done
  for _ in $(seq 120); do
    [ "$(timeout 10 sinfo --noheader --Node --states=idle --format=%N 2>/dev/null | wc -l)" = "$slurm_nodes" ] && return
    sleep 0.5
  done
  echo "the nodes do not come up:"
  tail -n 5 "$slurm"/*.log
  return 1
}

start_controller() { slurmctld -f "$SLURM_CONF" >>"$slurm/slurmctld.out" 2>&1; }
stop_controller() { end "$(cat "$slurm/slurmctld.pid" 2>/dev/null)"; } # it saves its state
start_node() { slurmd -f "$SLURM_CONF" -N "n$1" >>"$slurm/n$1.out" 2>&1; }


# Processes of jobs on node N, each after the slurmstepd above it. Only they have this node and this SLURM_CONF.
processes_of_node() { # N
  local folder parent
  for folder in /proc/[0-9]*; do
    [ "$(tr '\0' '\n' 2>/dev/null <"$folder/environ" | grep -cxF -e "SLURMD_NODENAME=n$1" -e "SLURM_CONF=$SLURM_CONF")" = 2 ] || continue
    parent=$(sed -n 's/^PPid:[^0-9]*//p' "$folder/status" 2>/dev/null)
    [ "$(cat "/proc/$parent/comm" 2>/dev/null)" != slurmstepd ] || echo "$parent"
    echo "${folder#/proc/}"
  done
}

# What a power cut does to node N: slurmd, the steps and all that they started, at once and without a word.
kill_node() { # N
  local found
  kill -9 "$(cat "$slurm/n$1.pid")"
  while found=$(processes_of_node "$1") && [ -n "$found" ]; do
    echo "$found" | xargs kill -9 2>/dev/null
    sleep 0.1
  done
  rm -f "$slurm/n$1.pid"
}

end() { # PID
  [ -n "$1" ] && kill "$1" 2>/dev/null || return 0
  for _ in $(seq 100); do kill -0 "$1" 2>/dev/null || return 0; sleep 0.1; done
  kill -9 "$1" 2>/dev/null
}

stop_slurm() { # leaves no process; the folder is the caller's
  local node
  [ -n "${slurm-}" ] || return 0
  for node in $(seq "$slurm_nodes"); do [ -e "$slurm/n$node.pid" ] && kill_node "$node"; done
  for node in $(seq "$slurm_nodes"); do processes_of_node "$node" | xargs -r kill -9 2>/dev/null; done
  stop_controller
  end "$(cat "$slurm/munge/pid" 2>/dev/null)"
  unset slurm SLURM_CONF
}
