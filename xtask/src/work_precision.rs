//! Time beside error: what the same error costs several programs.

use std::fmt::Write as _;

/// The program whose time is 1.
const OWN: &str = "Kempe";

/// Runs are compared by what it takes them to stay below these relative errors.
const LEVELS: [f64; 4] = [1e-3, 1e-5, 1e-7, 1e-9];

/// One run of one program.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    case: String,
    peer: String,
    method: String,
    error: f64,
    seconds: f64,
}

/// Runs from lines `case,peer,method,error,seconds` below a heading. A method with commas is in quotes.
///
/// # Errors
///
/// The line that is no run.
pub fn read(text: &str) -> Result<Vec<Run>, String> {
    let run = |line: &str| {
        let (case, rest) = line.split_once(',')?;
        let (peer, rest) = rest.split_once(',')?;
        let (rest, seconds) = rest.rsplit_once(',')?;
        let (method, error) = rest.rsplit_once(',')?;
        Some(Run {
            case: case.into(),
            peer: peer.into(),
            method: method.trim_matches('"').into(),
            error: error.parse().ok()?,
            seconds: seconds.parse().ok()?,
        })
    };
    let lines = text.lines().skip(1);
    lines
        .map(|line| run(line).ok_or_else(|| format!("`{line}` is no run of a benchmark")))
        .collect()
}

/// The fastest run of a program on a case whose error is at most `level`.
fn fastest<'a>(runs: &'a [Run], case: &str, peer: &str, level: f64) -> Option<&'a Run> {
    let enough = |run: &&Run| run.case == case && run.peer == peer && run.error <= level;
    let right = runs.iter().filter(enough);
    right.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

/// Names, each once, in the order in which they come.
fn once<'a>(names: impl Iterator<Item = &'a String>) -> Vec<&'a str> {
    let mut seen: Vec<&str> = Vec::new();
    for name in names {
        if !seen.contains(&name.as_str()) {
            seen.push(name);
        }
    }
    seen
}

/// For every case that a peer has run and every error: the time in ms of the fastest run that keeps below it, of Kempe and of each
/// peer, how many times Kempe's time a peer's is, and how it was found. A dash stands where no run keeps below it.
pub fn table(runs: &[Run]) -> String {
    let peers = once(runs.iter().map(|run| &run.peer).filter(|peer| *peer != OWN));
    let compared = runs.iter().filter(|run| run.peer != OWN);
    let mut text = format!("{:<18} {:>7} {:>11}", "time in ms", "error <", OWN);
    for peer in &peers {
        let _ = write!(text, " {peer:>16} {:>9}  {:<34}", "x Kempe", "");
    }
    let mut lines = vec![text];
    for case in once(compared.map(|run| &run.case)) {
        for level in LEVELS {
            let own = fastest(runs, case, OWN, level);
            let mut line = format!("{case:<18} {level:>7.0e} {:>11}", milliseconds(own));
            for peer in &peers {
                let found = fastest(runs, case, peer, level);
                let ratio = match (own, found) {
                    (Some(own), Some(found)) => format!("{:.2}", found.seconds / own.seconds),
                    _ => "-".into(),
                };
                let method = found.map_or("", |run| &run.method);
                let time = milliseconds(found);
                let _ = write!(line, " {time:>16} {ratio:>9}  {method:<34}");
            }
            lines.push(line);
        }
    }
    lines
        .iter()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

fn milliseconds(run: Option<&Run>) -> String {
    run.map_or("-".into(), |run| format!("{:.3}", 1e3 * run.seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUNS: &str = "case,peer,method,error,seconds
fall,Kempe,tolerance 1e-4,2e-4,0.001
fall,Kempe,tolerance 1e-10,3e-9,0.004
alone,Kempe,tolerance 1e-4,1e-5,0.002
fall,other 1.0,\"alpha, 100 steps\",9e-4,0.010
fall,other 1.0,\"alpha, 1000 steps\",9e-6,0.1
fall,other 1.0,explicit,8e-6,0.05
";

    #[test]
    fn the_fastest_run_that_is_right_enough_counts() {
        let runs = read(RUNS).unwrap();
        assert_eq!(fastest(&runs, "fall", "Kempe", 1e-3), Some(&runs[0]));
        assert_eq!(fastest(&runs, "fall", "other 1.0", 1e-3), Some(&runs[3]));
        assert_eq!(fastest(&runs, "fall", "other 1.0", 1e-5), Some(&runs[5]));
        assert_eq!(fastest(&runs, "fall", "other 1.0", 1e-7), None);
        let shown = table(&runs);
        let words: Vec<Vec<&str>> = (shown.lines())
            .map(|line| line.split_whitespace().collect())
            .collect();
        let first = [
            "fall", "1e-3", "1.000", "10.000", "10.00", "alpha,", "100", "steps",
        ];
        assert_eq!(words[1], first);
        assert_eq!(
            words[2],
            ["fall", "1e-5", "4.000", "50.000", "12.50", "explicit"]
        );
        assert_eq!(words[3], ["fall", "1e-7", "4.000", "-", "-"]);
        assert_eq!(words[4], ["fall", "1e-9", "-", "-", "-"]);
        assert_eq!(words.len(), 5, "a case without peers stands alone already");
    }

    #[test]
    fn what_is_no_run_is_told() {
        let error = read("case,peer,method,error,seconds\nfall,Kempe,fast,1e-3").unwrap_err();
        assert!(error.contains("`fall,Kempe,fast,1e-3`"), "{error}");
    }
}
