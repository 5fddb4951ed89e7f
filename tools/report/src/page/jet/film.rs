//! Films of the runs, and pictures out of them.

use ::run::Failure;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::run::Run;
use crate::draw::canvas::Canvas;
use crate::draw::film::film;
use crate::html::{escape, figure, picture, side_by_side};
use crate::page::encoding;
use crate::picture::jet;

/// Most pictures of a film.
const MOST: usize = 60;
/// Each is shown so long \[ms\].
const SHOWN: u16 = 100;
/// Pictures that stand still.
const STILLS: usize = 4;

/// The section.
pub(super) fn section(runs: &[Run]) -> Result<String, Failure> {
    let mut body = String::new();
    for run in runs {
        let count = run.frames();
        if count == 0 {
            continue;
        }
        let every = count.div_ceil(MOST);
        let shown: Vec<usize> = (0..count).step_by(every).collect();
        let pictures = shown
            .iter()
            .map(|index| one(run, *index))
            .collect::<Result<Vec<_>, _>>()?;
        let data = film(&pictures, SHOWN).map_err(|e| encoding(&e))?;
        let words = format!(
            "{}: water green, solid red, broken blue, plate yellow",
            run.name
        );
        let moving = format!(
            "<img class=\"picture\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">",
            pictures[0].width,
            pictures[0].height,
            escape(&words),
            STANDARD.encode(data)
        );
        body += &format!("<h3>{}</h3>\n", escape(&run.name));
        body += &figure(&moving, &format!("{words}; {} pictures.", pictures.len()));
        let mut stills = Vec::new();
        for still in 1..=STILLS.min(pictures.len()) {
            let place = (pictures.len() - 1) * still / STILLS.min(pictures.len());
            let image = picture(&pictures[place], &words).map_err(|e| encoding(&e))?;
            stills.push(figure(&image, ""));
        }
        body += &stills.chunks(2).map(side_by_side).collect::<String>();
    }
    Ok(body)
}

fn one(run: &Run, index: usize) -> Result<Canvas, Failure> {
    let (time, dots) = run.dots(index)?;
    let title = format!("{}: {:.3} ms", run.name, 1e3 * time);
    let window = run.window()?;
    Ok(jet::picture(
        window,
        &dots,
        |at| run.is_wall(at),
        &title,
        run.up_title(),
    ))
}
