//! How a simulation was done, and how well, in words.

use kempe_model::{LinkId, Model};
use kempe_simulate::{Question, Simulated};
use kempe_units::Dimension;

use crate::result::{Listing, StudyResult};
use crate::table::largest;
use crate::unit::Units;

/// At most so many changes of what tells the place are listed.
const TOLD: usize = 4;

/// How it was done, and how well.
pub(super) fn how(
    model: &Model,
    question: &Question,
    found: &Simulated,
    result: &StudyResult,
) -> Listing {
    let units = &Units::of(model);
    let balance = result.table.balance.as_ref();
    let worst = |column: Option<&Vec<f64>>| {
        let sizes: Vec<f64> = column.into_iter().flatten().map(|x| x.abs()).collect();
        largest(&sizes).map(|(_, off)| format!("{off:.1e}"))
    };
    let used = found.used;
    let explicit = "explicit Runge-Kutta of order 8 (Dormand and Prince)";
    let implicit = "implicit Runge-Kutta of order 5 (Radau IIA)";
    let methods: Vec<String> = match used.implicit_from {
        None => vec![explicit.to_owned()],
        Some(_) if used.explicit == 0 => vec![implicit.to_owned()],
        Some(from) => vec![
            format!("{explicit}, {} steps,", used.explicit),
            format!(
                "{implicit}, {} steps, first at {}",
                used.implicit,
                units.text(from, Dimension::TIME)
            ),
        ],
    };
    let mut rows = vec![
        vec![
            "method".to_owned(),
            format!("{}, {}", coordinates(found), methods.join(" and ")),
        ],
        vec![
            "steps".to_owned(),
            format!(
                "{}, {} evaluations",
                used.explicit + used.implicit,
                found.evaluations
            ),
        ],
        vec![
            "energy".to_owned(),
            match worst(balance.map(|b| &b.energy)) {
                Some(off) => format!("balanced to {off} of the most that was moved"),
                None => "none was moved".to_owned(),
            },
        ],
        vec![
            "power".to_owned(),
            match worst(balance.map(|b| &b.power)) {
                Some(off) => format!(
                    "inverse dynamics asks no more of what is let go than it gives, to {off}"
                ),
                None => "none was asked for: in every row it rests on a stop, or friction holds it"
                    .to_owned(),
            },
        ],
    ];
    if let Some(tree) = &found.tree {
        rows.insert(
            2,
            vec![
                "closures".to_owned(),
                format!(
                    "closed in every state; at the end of a step they were off by {:.1e} of the mechanism's size at most",
                    tree.off
                ),
            ],
        );
    }
    if found.across.steps > 0 {
        rows.insert(
            2,
            vec![
                "change points".to_owned(),
                format!(
                    "{} passed, each by a step across whose rates agree on both sides to {:.1e} of what moves",
                    found.across.steps, found.across.off
                ),
            ],
        );
    }
    if let Some(told) = told(model, question, found) {
        rows.insert(1, vec!["coordinates".to_owned(), told]);
    }
    Listing {
        title: "How it was simulated".to_owned(),
        head: Vec::new(),
        rows,
    }
}

/// Which coordinates told the place.
fn coordinates(found: &Simulated) -> String {
    match &found.tree {
        None => "minimal coordinates".to_owned(),
        Some(tree) => format!(
            "{} coordinates of a spanning tree with {} ties",
            tree.coordinates, tree.ties
        ),
    }
}

/// What told the place of the mechanism, where that was not what was let go all the time: `travel, from 0.1 s angle(crank)`.
fn told(model: &Model, question: &Question, found: &Simulated) -> Option<String> {
    let units = Units::of(model);
    let drive = |place: usize| {
        let id = question.free.get(place)?;
        Some(model.drives.get(id.index())?.name.clone())
    };
    let link = |link: &LinkId| {
        let link = model.links.get(link.index())?;
        Some(format!("angle({})", link.name))
    };
    let told = found.told_by();
    let mut parts: Vec<String> = (told.iter().enumerate().take(TOLD))
        .map(|(index, (since, links))| {
            let names = links.iter().enumerate();
            let names: Vec<String> = names
                .filter_map(|(place, it)| it.as_ref().map_or_else(|| drive(place), link))
                .collect();
            match index {
                0 => names.join(" and "),
                _ => format!(
                    "from {} {}",
                    units.text(*since, Dimension::TIME),
                    names.join(" and ")
                ),
            }
        })
        .collect();
    if told.len() > TOLD {
        parts.push(format!("and so on, {} times", told.len() - 1));
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}
