//! `tilebind completions`.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::{Failure, print};

/// Print completions for a shell
#[derive(Args)]
#[command(after_help = "\
Example:
  tilebind completions bash > ~/.local/share/bash-completion/completions/tilebind")]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub fn run<C: CommandFactory>(self) -> Result<(), Failure> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut C::command(), "tilebind", &mut text);
        print(&String::from_utf8_lossy(&text))
    }
}
