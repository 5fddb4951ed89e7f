//! `make sweep ENGINE=slurm` and a real Slurm on this machine: arrays of jobs with dependencies.

use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::json;
use verification::skipped::skip;

use super::study::Workshop;
use super::sweep::welds;

/// The daemons of a cluster of one machine; they end with it.
struct Cluster {
    folder: tempfile::TempDir,
    daemons: Vec<Child>,
}

fn is_there(program: &str) -> bool {
    let found = Command::new("sh")
        .args(["-c", &format!("command -v {program}")])
        .output();
    found.is_ok_and(|output| output.status.success())
}

fn said(program: &str, words: &[&str]) -> String {
    let output = Command::new(program).args(words).output().unwrap();
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap()
        .port()
}

impl Cluster {
    fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        for name in ["state", "spool"] {
            std::fs::create_dir(at(name)).unwrap();
        }
        std::fs::write(at("munge.key"), [7; 1024]).unwrap();
        let private = std::os::unix::fs::PermissionsExt::from_mode(0o600);
        std::fs::set_permissions(at("munge.key"), private).unwrap();
        let (host, user) = (said("hostname", &["-s"]), said("id", &["-un"]));
        let text = format!(
            "ClusterName=test\nSlurmctldHost={host}(127.0.0.1)\nSlurmctldPort={}\nSlurmdPort={}\n\
             AuthType=auth/munge\nAuthInfo=socket={}\nCryptoType=crypto/munge\nSlurmUser={user}\nSlurmdUser={user}\n\
             StateSaveLocation={}\nSlurmdSpoolDir={}\nSlurmctldPidFile={}\nSlurmdPidFile={}\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\n\
             SelectTypeParameters=CR_Core\nMpiDefault=none\nReturnToService=2\n\
             SchedulerParameters=sched_interval=1,bf_interval=1\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs={} State=UNKNOWN\n\
             PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n",
            free_port(),
            free_port(),
            at("munge.socket"),
            at("state"),
            at("spool"),
            at("slurmctld.pid"),
            at("slurmd.pid"),
            said("nproc", &[]),
        );
        std::fs::write(at("slurm.conf"), text).unwrap();
        let own = |name: &str, end: &str| format!("--{name}={}", at(&format!("munge.{end}")));
        let munge = [
            own("key-file", "key"),
            own("socket", "socket"),
            own("pid-file", "pid"),
            own("log-file", "log"),
            own("seed-file", "seed"),
        ];
        let mut cluster = Self {
            daemons: Vec::new(),
            folder,
        };
        let words = ["--force", "--foreground"].map(str::to_owned).into_iter();
        cluster.daemon("munged", &words.chain(munge).collect::<Vec<_>>());
        let socket = cluster.folder.path().join("munge.socket");
        wait("munged", || socket.exists());
        cluster.daemon("slurmctld", &["-D".to_owned(), "-c".to_owned()]);
        cluster.daemon("slurmd", &["-D".to_owned()]);
        wait("a node that waits for jobs", || {
            let states = cluster
                .command("sinfo")
                .args(["-h", "-o", "%t"])
                .output()
                .unwrap();
            String::from_utf8_lossy(&states.stdout).trim() == "idle"
        });
        cluster
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.folder.path().join("slurm.conf"));
        command
    }

    fn daemon(&mut self, program: &str, words: &[String]) {
        let log = std::fs::File::create(self.folder.path().join(format!("{program}.out"))).unwrap();
        let started = self
            .command(program)
            .args(words)
            .stdin(Stdio::null())
            .stdout(log.try_clone().unwrap())
            .stderr(log)
            .spawn();
        self.daemons.push(started.unwrap());
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        while let Some(mut daemon) = self.daemons.pop() {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

fn wait(what: &str, come: impl Fn() -> bool) {
    let begin = Instant::now();
    while !come() {
        assert!(
            begin.elapsed() < Duration::from_secs(30),
            "there is no {what}"
        );
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn a_cluster_makes_the_points_in_their_order_and_tells_what_failed() {
    let programs = ["munged", "slurmctld", "slurmd", "sbatch", "sinfo"];
    if let Some(missing) = programs.iter().find(|program| !is_there(program)) {
        let packages = "Debian: munge slurmctld slurmd slurm-client";
        let why = format!("{missing} is not here ({packages}): no sweep is submitted");
        skip("slurm", &why);
        return;
    }
    let cluster = Cluster::start();
    let workshop = Workshop::new();
    workshop.sweep(&welds(
        &json!([200, "impossible", 300]),
        &json!([0.01, 0.02]),
    ));
    let submit = |words: &[&str]| {
        let mut make = cluster.command("target/release/sweep");
        make.current_dir(&workshop.root)
            .args([
                "run",
                "pipelines/gmaw-quick/sweep.json",
                "--engine",
                "slurm",
                "--threads",
                "1",
            ])
            .args(words);
        make.output().unwrap()
    };
    let ended = submit(&["--wait"]);
    let text = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(
        ended.status.code(),
        Some(3),
        "{text}{}",
        logs(&workshop.root)
    );
    assert!(text.contains("4 of 6 points are made"), "{text}");
    let points = workshop.points();
    let made = |i: usize| points["points"][i]["failed"].is_null();
    assert_eq!(
        [0, 1, 2, 3, 4, 5].map(made),
        [true, true, false, false, true, true]
    );
    let log = workshop.root.join("log");
    let count = |name: &str| {
        let log = std::fs::read_to_string(&log).unwrap_or_default();
        log.lines().filter(|line| *line == name).count()
    };
    assert_eq!(["gasprop", "arcfvm", "poolsph"].map(count), [1, 3, 4]);
    // Here, all of it is up to date: the keys are the same.
    workshop.sweep(&welds(&json!([200, 300]), &json!([0.01, 0.02])));
    let here = workshop.ask(&["sweep", "STUDY=gmaw-quick"]);
    assert!(
        here.status.success(),
        "{}",
        String::from_utf8_lossy(&here.stderr)
    );
    assert_eq!(["gasprop", "arcfvm", "poolsph"].map(count), [1, 3, 4]);
    // Without waiting, the last job makes the page.
    let page = workshop.root.join("build/gmaw-quick/sweep.html");
    std::fs::remove_file(&page).unwrap();
    assert!(submit(&[]).status.success());
    wait("page", || page.exists());
}

/// What jobs said, for a test that fails.
fn logs(root: &Path) -> String {
    let folder = root.join("build/gmaw-quick/sweep/slurm");
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let logs = files.filter(|f| f.path().extension().is_some_and(|e| e == "log"));
    logs.map(|f| {
        let text = std::fs::read_to_string(f.path()).unwrap_or_default();
        format!("{}:\n{text}\n", f.path().display())
    })
    .collect()
}
