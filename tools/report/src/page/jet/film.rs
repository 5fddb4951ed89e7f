//! Films of the runs, and pictures out of them.

use ::run::Failure;

use super::run::Run;
use crate::draw::canvas::Canvas;
use crate::html::{FRAME_WIDTH, chosen, escape, figure, frames};
use crate::moments;
use crate::page::{encoding, moving};
use crate::picture::jet;

/// Most pictures of a film.
const MOST: usize = 60;

/// The section.
pub(super) fn section(runs: &[Run]) -> Result<String, Failure> {
    let mut body = String::new();
    for run in runs {
        let count = run.frames();
        if count == 0 {
            continue;
        }
        let every = count.div_ceil(MOST);
        let shown = moments::every(count, every);
        let pictures = shown
            .iter()
            .map(|index| one(run, *index))
            .collect::<Result<Vec<_>, _>>()?;
        let words = format!(
            "{}: water green, solid red, broken blue, plate yellow",
            run.name
        );
        body += &format!("<h3>{}</h3>\n", escape(&run.name));
        body += &figure(
            &moving(&pictures, &words)?,
            &format!("{words}; {} pictures.", pictures.len()),
        );
        let still = chosen(pictures.len()).into_iter().map(|i| {
            let time = format!("{:.3} ms", 1e3 * run.time(shown[i])?);
            Ok((time, pictures[i].smaller(FRAME_WIDTH)))
        });
        let stills = still.collect::<Result<Vec<_>, Failure>>()?;
        body += &frames(&stills, &words).map_err(|e| encoding(&e))?;
    }
    Ok(body)
}

/// The picture of a frame.
pub(super) fn one(run: &Run, index: usize) -> Result<Canvas, Failure> {
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
