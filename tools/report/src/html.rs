//! A self-contained HTML page: sections, figures, tables, one style sheet.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::draw::canvas::Canvas;

const STYLE: &str = include_str!("style.css");

/// Text with the characters that HTML reserves replaced.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            other => out.push(other),
        }
    }
    out
}

/// A page that is put together from the top to the bottom.
#[derive(Debug)]
pub(crate) struct Page {
    title: String,
    lead: String,
    sections: Vec<(String, String)>,
}

impl Page {
    /// A page with a title and an introduction (HTML).
    pub(crate) fn new(title: &str, lead: &str) -> Self {
        Self {
            title: title.to_owned(),
            lead: lead.to_owned(),
            sections: Vec::new(),
        }
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
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
             <header>\n<h1>{title}</h1>\n{}</header>\n{nav}{bodies}</main>\n</body>\n</html>\n",
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

/// A picture inside the page; `describes` is read where it cannot be seen.
///
/// # Errors
/// When the picture cannot be encoded.
pub(crate) fn picture(canvas: &Canvas, describes: &str) -> Result<String, png::EncodingError> {
    let data = STANDARD.encode(canvas.png()?);
    Ok(format!(
        "<img class=\"picture\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{data}\">",
        canvas.width,
        canvas.height,
        escape(describes)
    ))
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
    fn a_page_asks_for_nothing_from_outside() {
        let html = Page::new("T", "").render();
        assert!(!html.contains("http") && !html.contains("<script"));
    }
}
