//! The program `arcfvm`.

fn main() -> std::process::ExitCode {
    run::main::<arcfvm::program::ArcFvm>()
}
