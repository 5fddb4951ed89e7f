//! Prints the schema of sheets of substances.

#![allow(clippy::print_stdout, reason = "that is what it is for")]

fn main() {
    print!("{}", run::scene::schema_text(&run::scene::sheet_schema()));
}
