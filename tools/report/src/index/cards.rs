//! Studies as cards: the first picture of the page, small, its name, and how many of its verdicts are good.

use std::io::Cursor;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::draw::canvas::Canvas;
use crate::html::{escape, verdict};

/// Width of the picture of a card \[px\], and its colours.
const WIDTH: usize = 440;
const COLOURS: usize = 48;
/// Longest plot that is shown for want of a picture \[byte\].
const PLOT_MOST: usize = 60_000;

/// A page of a study.
pub(super) struct Card {
    /// What it is called.
    pub(super) name: String,
    /// Its address from the page of all.
    pub(super) link: String,
    /// Its text; empty where it cannot be read.
    pub(super) page: String,
}

/// All cards; nothing without any.
pub(super) fn cards(all: &[Card]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let each: String = all.iter().map(card).collect();
    format!("<ul class=\"cards\">\n{each}</ul>\n")
}

fn card(of: &Card) -> String {
    let shown = picture(&of.page, &of.name)
        .or_else(|| plot(&of.page))
        .unwrap_or_default();
    format!(
        "<li><a href=\"{}\">{shown}<b>{}</b></a>{}</li>\n",
        escape(&of.link),
        escape(&of.name),
        verdicts(&of.page)
    )
}

/// What stands between two texts for the first time.
fn between<'a>(text: &'a str, before: &str, after: &str) -> Option<&'a str> {
    let from = text.find(before)? + before.len();
    let length = text[from..].find(after)?;
    Some(&text[from..from + length])
}

/// The first picture, made small.
fn picture(page: &str, name: &str) -> Option<String> {
    let data = between(page, "src=\"data:image/png;base64,", "\"")?;
    let canvas = decoded(&STANDARD.decode(data).ok()?)?.smaller(WIDTH);
    let small = STANDARD.encode(canvas.png(COLOURS).ok()?);
    Some(format!(
        "<img width=\"{}\" height=\"{}\" alt=\"The first picture of {}\" src=\"data:image/png;base64,{small}\">",
        canvas.width,
        canvas.height,
        escape(name)
    ))
}

/// A picture of three colours a pixel from its PNG.
fn decoded(bytes: &[u8]) -> Option<Canvas> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut pixels).ok()?;
    let size = [info.width, info.height].map(|n| n as usize);
    (info.color_type == png::ColorType::Rgb).then(|| Canvas::of_rgb(size, &pixels))
}

/// The first plot that stands still.
fn plot(page: &str) -> Option<String> {
    let body = between(page, "<svg class=\"plot\" ", "</svg>")?;
    (body.len() < PLOT_MOST).then(|| format!("<svg class=\"plot\" {body}</svg>"))
}

/// How many verdicts of a page are good, bad and open; nothing where it has none.
fn verdicts(page: &str) -> String {
    let count = |class: &str| page.matches(&format!("<span class=\"{class}\">")).count();
    let told = [
        ("good", "hold", Some(true)),
        ("bad", "missed", Some(false)),
        ("open", "not judged", None),
    ];
    let told = told.map(|(class, word, holds)| (count(class), word, holds));
    let words: Vec<String> = told
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, word, holds)| verdict(&format!("{count} {word}"), holds))
        .collect();
    match words.is_empty() {
        true => String::new(),
        false => format!("<span>{}</span>", words.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::canvas::Rect;
    use crate::html::{Page, paragraph, picture as whole};

    fn page(body: String) -> String {
        let mut page = Page::new("T", "");
        page.section("A", body);
        page.render()
    }

    #[test]
    fn a_card_shows_the_first_picture_small_and_counts_verdicts() {
        let mut canvas = Canvas::new(1760, 880);
        let right = Rect {
            x: 880.0,
            y: 0.0,
            w: 880.0,
            h: 880.0,
        };
        canvas.fill(right, [0.0, 0.0, 1.0]);
        let body = whole(&canvas, "x").unwrap()
            + &verdict("within", Some(true))
            + &verdict("within", Some(true))
            + &verdict("outside", Some(false));
        let html = cards(&[Card {
            name: "weld".to_owned(),
            link: "../weld/report.html".to_owned(),
            page: page(body),
        }]);
        assert!(html.contains("href=\"../weld/report.html\"") && html.contains("<b>weld</b>"));
        assert!(html.contains("2 hold") && html.contains("1 missed") && !html.contains("judged"));
        let data = between(&html, "base64,", "\"").unwrap();
        let small = decoded(&STANDARD.decode(data).unwrap()).unwrap();
        assert_eq!([small.width, small.height], [440, 220]);
        let rgb = small.rgb();
        assert_eq!(rgb[..3], [255, 255, 255]);
        assert_eq!(rgb[rgb.len() - 3..], [0, 0, 255]);
    }

    #[test]
    fn a_page_without_pictures_shows_a_plot_and_one_without_either_its_name() {
        let plot = "<svg class=\"plot\" viewBox=\"0 0 1 1\"><path d=\"M0 0\"/></svg>";
        let of = |page: String| {
            cards(&[Card {
                name: "a".to_owned(),
                link: "a.html".to_owned(),
                page,
            }])
        };
        assert!(of(page(plot.to_owned())).contains(plot));
        let bare = of(page(paragraph("x")));
        assert!(bare.contains("<b>a</b>") && !bare.contains("<img") && !bare.contains("<svg"));
        assert!(
            of(page("<img src=\"data:image/png;base64,AAAA\">".to_owned())).contains("<b>a</b>")
        );
        assert_eq!(cards(&[]), "");
    }
}
