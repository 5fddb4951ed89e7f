//! Points made by HyperQueue: one job whose tasks await each other.

use std::process::Command;

use run::Failure;

use crate::files::keep;
use crate::here::status;
use crate::points::Points;
use crate::rules::make_alone;

/// Submits the job, and ends when all its tasks have.
///
/// # Errors
/// When `hq` is not there, or refuses the job.
pub(crate) fn run(points: &Points, threads: usize) -> Result<(), Failure> {
    let path = points.out.join("hyperqueue.toml");
    let here = std::env::current_dir().unwrap_or_default();
    keep(&path, &job(points, threads, &here.display().to_string()))?;
    // What comes from elsewhere is made first, by its own rules.
    let elsewhere = points.made_elsewhere();
    if !elsewhere.is_empty() {
        let mut make = Command::new("make");
        make.args(["--no-print-directory", &format!("THREADS={threads}")]);
        if !status(make.args(elsewhere))? {
            return Err(Failure::Other(
                "what the sweep is made from was not made".to_owned(),
            ));
        }
    }
    let mut submit = Command::new("hq");
    submit.args(["job", "submit-file"]).arg(&path);
    if !status(&mut submit)? {
        return Err(Failure::Other(format!("hq refused {}", path.display())));
    }
    // Tasks that failed are told by what they left.
    status(Command::new("hq").args(["job", "wait", "last"]))?;
    Ok(())
}

/// The job definition file: a task for each run, after the tasks that make its inputs.
fn job(points: &Points, threads: usize, here: &str) -> String {
    let mut text = format!("name = {}\n", quoted(&points.sweep.study));
    for (id, run) in points.runs.iter().enumerate() {
        let out = run.out.display().to_string();
        let words = make_alone(points, &threads.to_string(), &out);
        let words: Vec<String> = words.iter().map(|word| quoted(word)).collect();
        let after: Vec<String> = run.after.iter().map(usize::to_string).collect();
        text += &format!(
            "\n[[task]]\nid = {id}\ncommand = [{}]\ndeps = [{}]\ncwd = {}\nstdout = \"none\"\nstderr = \"none\"\n\
             [[task.request]]\nresources = {{ \"cpus\" = {threads} }}\n",
            words.join(", "),
            after.join(", "),
            quoted(here),
        );
    }
    text
}

/// A text of TOML.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_await_the_tasks_that_make_their_inputs() {
        let text = job(&crate::points::tests::welds(), 4, "/welds of mine");
        let task = "\
[[task]]
id = 5
command = [\"make\", \"--no-print-directory\", \"-f\", \"build/welds/sweep/rules.mk\", \"THREADS=4\", \
\"build/welds/sweep/current-200-speed-0.01/pool.mcap\"]
deps = [1, 2]
cwd = \"/welds of mine\"
";
        assert!(text.contains(task), "{text}");
        assert_eq!(text.matches("[[task]]").count(), 7);
    }
}
