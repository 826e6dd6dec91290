//! Colours for the verdicts in reports, on a terminal that supports them.

use anstream::stream::RawStream;
use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};

const BAD: Style = AnsiColor::Red.on_default().bold();
const GOOD: Style = AnsiColor::Green.on_default().bold();

/// The coloured words, which stand at the beginning or at the end of a line of a report, and their
/// styles.
const VERDICTS: [(&str, Style); 6] = [
    ("FAILED", BAD),
    ("STOPPED", BAD),
    ("THE CLOCK IS NOT REACHED", BAD),
    ("ALL HOLDS", GOOD),
    ("DONE", GOOD),
    ("PASSED", GOOD),
];

/// True if colours are wanted: the stream is a terminal and `NO_COLOR` is not set, or
/// `CLICOLOR_FORCE` is set.
pub fn wanted(stream: &impl RawStream) -> bool {
    AutoStream::choice(stream) != ColorChoice::Never
}

/// Returns the text with a word of [`VERDICTS`] coloured where it begins or ends a line.
pub fn painted(text: &str) -> String {
    text.split_inclusive('\n').map(line).collect()
}

fn line(line: &str) -> String {
    let (body, end) = line.strip_suffix('\n').map_or((line, ""), |body| (body, "\n"));
    let paint =
        |style: &Style, word: &str| format!("{}{word}{}", style.render(), style.render_reset());
    for (word, style) in &VERDICTS {
        if let Some(rest) =
            body.strip_prefix(word).filter(|rest| !rest.starts_with(char::is_alphanumeric))
        {
            return format!("{}{rest}{end}", paint(style, word));
        }
        if let Some(rest) = body.strip_suffix(word).filter(|rest| rest.ends_with(' ')) {
            return format!("{rest}{}{end}", paint(style, word));
        }
    }
    line.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_verdicts_are_coloured() {
        let text = "x  1/1  FAILED\nFAILED axis x: late\nwrote FAILED.vcd\nALL HOLDS\nDONEL\n";
        let shown = painted(text);
        let red = |word: &str| format!("\u{1b}[1m\u{1b}[31m{word}\u{1b}[0m");
        let green = red("ALL HOLDS").replace("[31m", "[32m");
        assert_eq!(
            shown,
            format!(
                "x  1/1  {}\n{} axis x: late\nwrote FAILED.vcd\n{green}\nDONEL\n",
                red("FAILED"),
                red("FAILED")
            )
        );
    }
}
