//! One trial: a changed file, the programs that read it, and what they may not do.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::chance::Chance;
use crate::file::{self, Depth};
use crate::judge::{TIME, faults};
use crate::seeds::{Artefact, Scene, Seeds};
use crate::watch::{Bounds, Ended, run};
use crate::{Campaign, Finding, MOST, json};

/// A run is asked to stop after this time.
const MOMENT: Duration = Duration::from_secs(2);
/// Ends of a stage: done, failed, refused, warned, interrupted.
const ENDS: [i32; 5] = [0, 1, 2, 3, 130];

/// What a trial came to.
#[derive(Debug, Default)]
pub(crate) struct Done {
    pub(crate) findings: Vec<Finding>,
    /// Exit code of each program, or the signal that ended it.
    pub(crate) codes: Vec<String>,
}

/// A worker with a folder of its own.
pub(crate) struct Trial<'a> {
    campaign: &'a Campaign,
    seeds: &'a Seeds,
    folder: PathBuf,
}

impl<'a> Trial<'a> {
    pub(crate) fn new(
        campaign: &'a Campaign,
        seeds: &'a Seeds,
        worker: usize,
    ) -> Result<Self, String> {
        Ok(Self {
            campaign,
            seeds,
            folder: campaign.out.join(format!("work-{worker}")),
        })
    }

    pub(crate) fn one(&self, sort: &str, number: u64) -> Result<Done, String> {
        let told = |e: std::io::Error| format!("{}: {e}", self.folder.display());
        if self.folder.exists() {
            std::fs::remove_dir_all(&self.folder).map_err(told)?;
        }
        std::fs::create_dir_all(&self.folder).map_err(told)?;
        let chance = Chance::of(self.campaign.seed, number);
        let mut own = One {
            of: self,
            name: format!("{sort} {number}"),
            chance,
            done: Done::default(),
        };
        match sort {
            "scene" => own.scene(false)?,
            "run" => own.scene(true)?,
            _ => own.file()?,
        }
        if !own.done.findings.is_empty() {
            let kept = self
                .campaign
                .out
                .join("found")
                .join(own.name.replace(' ', "-"));
            std::fs::create_dir_all(&kept).map_err(told)?;
            for entry in std::fs::read_dir(&self.folder).map_err(told)?.flatten() {
                if entry.path().is_file() {
                    std::fs::copy(entry.path(), kept.join(entry.file_name())).map_err(told)?;
                }
            }
        }
        Ok(own.done)
    }
}

/// A trial while it is done.
struct One<'a> {
    of: &'a Trial<'a>,
    name: String,
    chance: Chance,
    done: Done,
}

impl One<'_> {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<String, String> {
        let path = self.of.folder.join(name);
        std::fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(path.display().to_string())
    }

    /// Runs a program and notes what it may not do.
    fn start(
        &mut self,
        program: &str,
        arguments: &[String],
        codes: &[i32],
        stop: Option<Duration>,
    ) -> Result<Ended, String> {
        let bounds = Bounds {
            time: TIME,
            memory: MOST,
            stop,
        };
        let path = self.of.campaign.programs.join(program);
        let ended = run(&path, arguments, &self.of.folder, bounds)?;
        let end = match (ended.code, ended.signal) {
            (Some(code), _) => code.to_string(),
            (None, signal) => format!("signal {}", signal.unwrap_or(0)),
        };
        self.done.codes.push(end);
        for (kind, said) in faults(&ended, codes) {
            self.find(kind, program, arguments, said);
        }
        if ended.over.is_none() {
            self.leftovers(program, arguments);
        }
        Ok(ended)
    }

    fn find(&mut self, kind: &str, program: &str, arguments: &[String], said: String) {
        self.done.findings.push(Finding {
            kind: kind.to_owned(),
            trial: self.name.clone(),
            command: format!("{program} {}", arguments.join(" ")),
            said,
        });
    }

    /// Temporary files that a program leaves behind when it ends.
    fn leftovers(&mut self, program: &str, arguments: &[String]) {
        let entries = std::fs::read_dir(&self.of.folder)
            .into_iter()
            .flatten()
            .flatten();
        let left = entries.map(|e| e.file_name().to_string_lossy().into_owned());
        let left: Vec<String> = left.filter(|name| name.contains("trial")).collect();
        if !left.is_empty() {
            self.find("leftover", program, arguments, left.join(", "));
        }
    }

    fn scene(&mut self, runs: bool) -> Result<(), String> {
        let scene = self.seed();
        let mut value = scene.value.clone();
        let donor = self.seed().value;
        for _ in 0..=self.chance.below(3) {
            match self.of.seeds.schemas.get(&scene.tool) {
                _ if self.chance.one_in(if runs { 2 } else { 3 }) => {
                    json::rescale(&mut value, &mut self.chance)
                }
                Some(schema) if self.chance.one_in(2) => {
                    schema.extend(&mut value, &mut self.chance)
                }
                _ => json::change(&mut value, &donor, &mut self.chance),
            }
        }
        let text = json::text(&value);
        let bytes = if self.chance.one_in(10) {
            json::spoilt(&text, &mut self.chance)
        } else {
            text.into_bytes()
        };
        let mut arguments = vec![if runs { "run" } else { "check" }.to_owned()];
        if self.chance.one_in(8) {
            // What is changed may stand in a patch as well.
            arguments.push(self.write("scene.json", json::text(&scene.value).as_bytes())?);
            arguments.extend(["--patch".to_owned(), self.write("patch.json", &bytes)?]);
        } else {
            arguments.push(self.write("scene.json", &bytes)?);
        }
        arguments.extend(self.inputs(&scene.tool));
        if !runs {
            self.start(&scene.tool, &arguments, &ENDS, None)?;
            return Ok(());
        }
        let out = self.of.folder.join("out.mcap");
        let more = [
            "--out",
            &out.display().to_string(),
            "--threads",
            "1",
            "--progress",
            "none",
        ];
        arguments.extend(more.map(str::to_owned));
        let ended = self.start(&scene.tool, &arguments, &ENDS, Some(MOMENT))?;
        if matches!(ended.code, Some(0 | 3)) {
            let record = out.with_extension("run.json");
            let written = [&out, &record].map(|path| path.display().to_string());
            let words = [vec!["validate".to_owned()], written.to_vec()].concat();
            let told = self.start("artefact", &words, &[0, 1], None)?;
            if told.code != Some(0) {
                let said = String::from_utf8_lossy(&told.out).into_owned();
                self.find("written and refused", &scene.tool, &arguments, said);
            }
        }
        Ok(())
    }

    /// A scene; each tool has as many trials as another.
    fn seed(&mut self) -> Scene {
        let all = &self.of.seeds.scenes;
        let tools: Vec<&String> = self.of.seeds.schemas.keys().collect();
        let tool = self.chance.pick(&tools).map_or("", |t| t.as_str());
        let own: Vec<&Scene> = all.iter().filter(|s| s.tool == tool).collect();
        match self.chance.pick(&own) {
            Some(scene) => (*scene).clone(),
            None => all[0].clone(),
        }
    }

    /// Sound inputs of a stage.
    fn inputs(&self, tool: &str) -> Vec<String> {
        let (input, made) = match tool {
            "arcfvm" => ("gas", "gas"),
            "poolsph" => ("arc", "source"),
            "avg" => ("frames", "frames"),
            _ => return Vec::new(),
        };
        let path = self.of.seeds.path(made).map(Path::display);
        path.map_or(Vec::new(), |p| {
            vec!["--input".to_owned(), format!("{input}={p}")]
        })
    }

    fn file(&mut self) -> Result<(), String> {
        let all = &self.of.seeds.artefacts;
        let [i, j] = [0; 2].map(|_| self.chance.below(all.len()));
        let (seed, donor) = (&all[i], &all[j]);
        let (bytes, depth) = file::change(&seed.bytes, &donor.bytes, &mut self.chance);
        let path = self.write("changed.mcap", &bytes)?;
        let told = self.start("artefact", &words(&["validate", &path]), &[0, 1], None)?;
        let good = told.code == Some(0);
        if good && depth == Depth::Bytes && bytes != seed.bytes {
            self.same(seed, &path)?;
        }
        self.looked_at(seed, &path)?;
        self.used(seed.name, &path, good)
    }

    /// What was changed and is found good must be what it was.
    fn same(&mut self, seed: &Artefact, path: &str) -> Result<(), String> {
        let seed = seed.path.display().to_string();
        let compared = words(&["diff", &seed, path]);
        let told = self.start("artefact", &compared, &[0, 1], None)?;
        if told.code != Some(0) {
            let said = String::from_utf8_lossy(&told.out).into_owned();
            self.find("changed and good", "artefact", &compared, said);
        }
        Ok(())
    }

    /// The programs that look into files.
    fn looked_at(&mut self, seed: &Artefact, path: &str) -> Result<(), String> {
        let folder = self.of.folder.join("export").display().to_string();
        let saved = self.of.folder.join("saved.mcap").display().to_string();
        let own = seed.path.display().to_string();
        let looks: [&[&str]; 8] = [
            &["info", path],
            &["ls", path],
            &["export", path, "--to", "csv", "--out", &folder],
            &["export", path, "--to", "vtu", "--out", &folder],
            &["export", path, "--to", "npz", "--out", &folder],
            &["diff", &own, path],
            &["recover", path, "--out", &saved],
            &["verify-hash", path],
        ];
        let look = looks[self.chance.below(looks.len())];
        self.start("artefact", &words(look), &[0, 1, 2], None)?;
        Ok(())
    }

    /// A program that makes something of a file: it must refuse what `validate` refuses.
    fn used(&mut self, name: &str, path: &str, good: bool) -> Result<(), String> {
        let named = format!("a={path}");
        let page = self.of.folder.join("page.html").display().to_string();
        let page = ["--study", "x", "--out", &page];
        let make = |words_: &[&str]| words(&[words_, &page].concat());
        let root = &self.of.campaign.root;
        let check = |scene: &str, input: &str| {
            let scene = root.join(scene).display().to_string();
            words(&["check", &scene, "--input", &format!("{input}={path}")])
        };
        let once = self.chance.one_in(2);
        let (program, arguments) = match name {
            "gas" if once => (
                "arcfvm",
                check("pipelines/verify/arc-surface/scene.json", "gas"),
            ),
            "gas" => ("report", make(&["gas", "--table", &named])),
            "source" if once => ("poolsph", check("tests/resume/weld.json", "arc")),
            "source" => ("report", make(&["page", "--arc", path])),
            "frames" if once => ("report", words(&["figures", "--pool", path])),
            "frames" if self.chance.one_in(2) => {
                ("avg", check("pipelines/gmaw-300a/avg.json", "frames"))
            }
            "frames" => ("report", make(&["page", "--pool", path])),
            "mean" => ("report", make(&["page", "--mean", path])),
            "heat" => ("report", make(&["heat", "--frames", &named])),
            "field" => ("report", make(&["field", "--fields", &named])),
            _ => return Ok(()),
        };
        let ended = self.start(program, &arguments, &[0, 1, 2, 3], None)?;
        if !good && matches!(ended.code, Some(0 | 3)) {
            self.find("refused and read", program, &arguments, ended.err);
        }
        Ok(())
    }
}

fn words(of: &[&str]) -> Vec<String> {
    of.iter().map(|word| (*word).to_owned()).collect()
}
