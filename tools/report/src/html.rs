//! A self-contained HTML page: sections, figures, tables, one style sheet.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::draw::canvas::Canvas;
use crate::draw::palette::MOST;

const STYLE: &str = include_str!("style.css");
/// The only script: a time slider under frames that stand beside each other without it.
const SLIDER: &str = include_str!("slider.js");
/// Frames are small: their width \[px\] and their colours. Twenty-five take about as much as two large pictures.
pub(crate) const FRAME_WIDTH: usize = 440;
const FRAME_COLOURS: usize = 32;
/// Of what the slider is for.
const FRAMES: &str = "class=\"frames\"";
const MOVING: &str = "class=\"plot moving\"";

/// Text with the characters that HTML reserves replaced.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // A page of text may hold no other control characters.
            other if other.is_control() && !matches!(other, '\n' | '\r' | '\t') => {
                out.push(char::REPLACEMENT_CHARACTER);
            }
            other => out.push(other),
        }
    }
    out
}

/// A part as per cent with its sign and so many digits; one that rounds to nothing is no less than nothing.
pub(crate) fn percent(part: f64, digits: usize) -> String {
    let text = format!("{:+.digits$} %", 100.0 * part);
    let nothing = text.chars().all(|c| !('1'..='9').contains(&c));
    if nothing && part.is_finite() {
        return format!("{:.digits$} %", 0.0);
    }
    text.replace('-', "\u{2212}")
}

/// A page that is put together from the top to the bottom.
#[derive(Debug)]
pub(crate) struct Page {
    title: String,
    lead: String,
    sections: Vec<(String, String)>,
    /// After so many seconds it is loaded anew.
    renewed_s: Option<f64>,
}

impl Page {
    /// A page with a title and an introduction (HTML).
    pub(crate) fn new(title: &str, lead: &str) -> Self {
        Self {
            title: title.to_owned(),
            lead: lead.to_owned(),
            sections: Vec::new(),
            renewed_s: None,
        }
    }

    /// Browsers load it anew after so many seconds.
    pub(crate) fn renew(&mut self, seconds: f64) {
        self.renewed_s = Some(seconds);
    }

    /// Adds a section with a heading and a body (HTML); nothing if the body is empty.
    pub(crate) fn section(&mut self, heading: &str, body: String) {
        if !body.is_empty() {
            self.sections.push((heading.to_owned(), body));
        }
    }

    /// The page as one file.
    pub(crate) fn render(&self) -> String {
        let title = escape(&self.title);
        let mut links = String::new();
        let mut bodies = String::new();
        for (i, (heading, body)) in self.sections.iter().enumerate() {
            let heading = escape(heading);
            links += &format!("<a href=\"#s{i}\">{heading}</a>\n");
            bodies += &format!("<section id=\"s{i}\">\n<h2>{heading}</h2>\n{body}</section>\n");
        }
        let nav = if self.sections.len() > 1 {
            format!("<nav>\n{links}</nav>\n")
        } else {
            String::new()
        };
        let slides = [FRAMES, MOVING].iter().any(|what| bodies.contains(what));
        let script = match slides {
            true => format!("<script>\n{SLIDER}</script>\n"),
            false => String::new(),
        };
        let renewal = |seconds: f64| {
            format!(
                "<meta http-equiv=\"refresh\" content=\"{:.0}\">\n",
                seconds.ceil()
            )
        };
        let renewal = self.renewed_s.map_or_else(String::new, renewal);
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             {renewal}<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
             <header>\n<h1>{title}</h1>\n{}</header>\n{nav}{bodies}</main>\n{script}</body>\n</html>\n",
            self.lead
        )
    }
}

/// A paragraph of plain text.
pub(crate) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escape(text))
}

/// A note of plain text that should not be overlooked.
pub(crate) fn note(text: &str) -> String {
    format!("<p class=\"note\">{}</p>\n", escape(text))
}

/// A figure: picture or plot (HTML) over a caption in plain text.
pub(crate) fn figure(content: &str, caption: &str) -> String {
    format!(
        "<figure>\n{content}\n<figcaption>{}</figcaption>\n</figure>\n",
        escape(caption)
    )
}

/// Figures beside each other where there is room.
pub(crate) fn side_by_side(figures: &[String]) -> String {
    match figures {
        [] => String::new(),
        [one] => one.clone(),
        many => format!("<div class=\"pair\">\n{}</div>\n", many.concat()),
    }
}

/// Tables beside each other where there is room.
pub(crate) fn beside(tables: &[String]) -> String {
    let filled = tables.iter().filter(|t| !t.is_empty());
    let all: String = filled.map(String::as_str).collect();
    if all.is_empty() {
        return all;
    }
    format!("<div class=\"tables\">\n{all}</div>\n")
}

/// A picture inside the page, which fills the window when it is clicked; `describes` is read where it cannot be seen.
///
/// # Errors
/// When the picture cannot be encoded.
pub(crate) fn picture(canvas: &Canvas, describes: &str) -> Result<String, png::EncodingError> {
    coloured(canvas, describes, MOST)
}

fn coloured(
    canvas: &Canvas,
    describes: &str,
    colours: usize,
) -> Result<String, png::EncodingError> {
    let data = STANDARD.encode(canvas.png(colours)?);
    Ok(enlarging(&format!(
        "<img class=\"picture\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{data}\">",
        canvas.width,
        canvas.height,
        escape(describes)
    )))
}

/// Frames one after another, each with its moment: one at a time under a slider, or beside each other where no script runs.
///
/// # Errors
/// When a picture cannot be encoded.
pub(crate) fn frames(
    moments: &[(String, Canvas)],
    describes: &str,
) -> Result<String, png::EncodingError> {
    let mut out = format!("<div {FRAMES}>\n");
    for (moment, canvas) in moments {
        let words = format!("{describes} {moment}");
        let small = canvas.smaller(FRAME_WIDTH);
        out += &figure(&coloured(&small, &words, FRAME_COLOURS)?, moment);
    }
    Ok(match moments.is_empty() {
        true => String::new(),
        false => out + "</div>\n",
    })
}

/// So many frames of `count` are shown, evenly, the first and the last among them.
pub(crate) fn chosen(count: usize) -> Vec<usize> {
    const FEW: usize = 25;
    if count <= FEW {
        return (0..count).collect();
    }
    let last = (count - 1) as f64;
    let place = |i: usize| (last * i as f64 / (FEW - 1) as f64).round() as usize;
    (0..FEW).map(place).collect()
}

/// A picture that fills the window when it is clicked, and goes back when it is clicked again: a hidden box that is ticked.
pub(crate) fn enlarging(image: &str) -> String {
    format!("<label class=\"zoom\"><input type=\"checkbox\">{image}</label>")
}

/// A table. Columns whose head begins with `#` hold numbers and stand right.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Rows {
    /// A table with the given column heads.
    pub(crate) fn new(head: &[&str]) -> Self {
        Self {
            head: head.iter().map(|h| (*h).to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// Gives a column another head.
    pub(crate) fn rename(&mut self, column: usize, head: &str) {
        if let Some(old) = self.head.get_mut(column) {
            head.clone_into(old);
        }
    }

    /// Adds a row of HTML cells.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// The table as HTML; nothing without rows.
    pub(crate) fn render(&self) -> String {
        if self.rows.is_empty() {
            return String::new();
        }
        let class = |i: usize| match self.head.get(i) {
            Some(head) if head.starts_with('#') => " class=\"number\"",
            _ => "",
        };
        let mut out = String::from("<div class=\"scroll\"><table>\n<thead><tr>");
        for (i, head) in self.head.iter().enumerate() {
            let text = escape(head.trim_start_matches('#'));
            out += &format!("<th{}>{text}</th>", class(i));
        }
        out += "</tr></thead>\n<tbody>\n";
        for row in &self.rows {
            out += "<tr>";
            for (i, cell) in row.iter().enumerate() {
                out += &format!("<td{}>{cell}</td>", class(i));
            }
            out += "</tr>\n";
        }
        out + "</tbody>\n</table></div>\n"
    }
}

/// A word that judges, marked for the eye as well as in words.
pub(crate) fn verdict(word: &str, holds: Option<bool>) -> String {
    let class = match holds {
        Some(true) => "good",
        Some(false) => "bad",
        None => "open",
    };
    format!("<span class=\"{class}\">{}</span>", escape(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_characters_do_no_harm() {
        assert_eq!(escape("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
        assert_eq!(escape("a\u{1b}[2Jb\n\u{85}"), "a\u{fffd}[2Jb\n\u{fffd}");
    }

    #[test]
    fn a_part_that_rounds_to_nothing_has_no_sign() {
        let told = [-0.0004, 0.0004, -0.0125, 0.0125, f64::NAN].map(|part| percent(part, 1));
        assert_eq!(told[..4], ["0.0 %", "0.0 %", "\u{2212}1.2 %", "+1.2 %"]);
        assert!(told[4].contains("NaN"));
    }

    #[test]
    fn empty_parts_leave_no_trace() {
        let mut page = Page::new("T", "");
        page.section("Absent", String::new());
        page.section("Present", paragraph("x"));
        let html = page.render();
        assert!(!html.contains("Absent") && html.contains("Present") && !html.contains("<nav>"));
        assert_eq!(Rows::new(&["a"]).render(), "");
    }

    #[test]
    fn a_slider_is_there_for_frames_alone() {
        let canvas = Canvas::new(4, 4);
        let moments = [
            ("0 s".to_owned(), canvas.clone()),
            ("1 s".to_owned(), canvas),
        ];
        let mut page = Page::new("T", "");
        page.section("A", frames(&moments, "x").unwrap());
        page.section("B", frames(&moments, "x").unwrap());
        let html = page.render();
        assert_eq!(html.matches("<script").count(), 1);
        assert_eq!(
            html.matches("<img").count(),
            4,
            "without a script all stand there"
        );
        assert_eq!(frames(&[], "x").unwrap(), "");
        assert_eq!(chosen(3), [0, 1, 2]);
        let many = chosen(201);
        assert_eq!((many.len(), many[0], many[24]), (25, 0, 200));
    }

    #[test]
    fn a_page_asks_for_nothing_from_outside() {
        let html = Page::new("T", "").render();
        assert!(!html.contains("http") && !html.contains("<script"));
    }
}
