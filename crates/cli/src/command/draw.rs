//! `kempe draw`: pictures of one pose, or of the motion.

use kempe_draw::raster::animation::{self, AnimationOptions};
use kempe_draw::raster::{self, RasterError};
use kempe_draw::{DrawOptions, Frame, MechanismView, Stage, Theme, dxf, svg};
use kempe_model::{Diagnostic, Model, MotionStudy, Severity, Study, StudyKind};
use kempe_study::{
    Setting, dimensions, drawing_frames, drawn, loaded_at, mechanism_view, pose_at, room_for,
};

use crate::arguments::Draw;
use crate::command::run::{nothing_to_run, warned};
use crate::exit::Exit;
use crate::files::{Loaded, load};
use crate::interrupt;
use crate::output::{Output, Stands, may_replace};
use crate::progress::Bar;
use crate::say::Speaker;

/// The kinds of picture, by the ending of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Svg,
    Png,
    Dxf,
    Gif,
    Apng,
}

/// Why there is no picture.
enum Failure {
    Usage(Diagnostic),
    TooLarge(Vec<Diagnostic>),
    Unsolved(Vec<Diagnostic>),
    Interrupted,
}

/// Runs `kempe draw`.
pub fn draw(arguments: &Draw) -> Exit {
    let mut speaker = Speaker::new(false, false).strictly(arguments.model.strict);
    let kind = match kind(arguments) {
        Ok(kind) => kind,
        Err(diagnostic) => {
            speaker.tell(&[*diagnostic]);
            return Exit::Usage;
        }
    };
    let loaded = match load(&arguments.model, &mut speaker) {
        Ok(loaded) => loaded,
        Err(exit) => return exit,
    };
    let place = Stands::at(&arguments.output)
        .and_then(|place| may_replace(&place, &loaded.inputs).map(|()| place));
    let place = match place {
        Ok(place) => place,
        Err(diagnostic) => {
            speaker.tell(&[*diagnostic]);
            return Exit::Usage;
        }
    };
    match picture(arguments, kind, &loaded.checked.model, &mut speaker) {
        Ok(_) if arguments.model.strict && speaker.exit() != Exit::Ok => {
            speaker.tell(&[warned(&arguments.output)]);
            speaker.exit()
        }
        Ok(bytes) => match write(arguments, &place, &loaded, &bytes) {
            Ok(()) => speaker.exit(),
            Err(diagnostic) => {
                speaker.tell(&[*diagnostic]);
                Exit::Usage
            }
        },
        Err(Failure::Usage(diagnostic)) => {
            speaker.tell(&[diagnostic]);
            Exit::Usage
        }
        Err(Failure::TooLarge(diagnostics)) => {
            speaker.tell(&diagnostics);
            Exit::Usage
        }
        Err(Failure::Unsolved(diagnostic)) => {
            speaker.tell(&diagnostic);
            Exit::CannotSolve
        }
        Err(Failure::Interrupted) => Exit::Interrupted,
    }
}

fn write(
    arguments: &Draw,
    place: &Stands,
    loaded: &Loaded,
    bytes: &[u8],
) -> Result<(), Box<Diagnostic>> {
    let mut output = Output::beside(&arguments.output, &loaded.inputs)?;
    output.add(place.name(), bytes)?;
    output.publish()?;
    Ok(())
}

/// A picture has room for so many sizes: rows of four-bars with more have texts over each other.
const MOST_SIZES: usize = 48;

fn kind(arguments: &Draw) -> Result<Kind, Box<Diagnostic>> {
    let ending = arguments
        .output
        .extension()
        .map(|e| e.to_string_lossy().to_lowercase());
    Ok(match ending.as_deref() {
        Some("svg") => Kind::Svg,
        Some("png") => Kind::Png,
        Some("dxf") => Kind::Dxf,
        Some("gif") => Kind::Gif,
        Some("apng") => Kind::Apng,
        _ => {
            let message = format!("{} is no kind of picture", arguments.output.display());
            let diagnostic = Diagnostic::error("unknown-picture", message);
            return Err(Box::new(
                diagnostic.help("its name ends in .svg, .png, .dxf, .gif or .apng"),
            ));
        }
    })
}

fn picture(
    arguments: &Draw,
    kind: Kind,
    model: &Model,
    speaker: &mut Speaker,
) -> Result<Vec<u8>, Failure> {
    let theme = if arguments.dark {
        Theme::Dark
    } else {
        Theme::Light
    };
    let options = DrawOptions {
        labels: !arguments.no_labels,
        steady: matches!(kind, Kind::Gif | Kind::Apng),
        ..DrawOptions::default()
    };
    let failed =
        |error: RasterError| Failure::Usage(Diagnostic::error("cannot-draw", error.to_string()));
    let moving = matches!(kind, Kind::Gif | Kind::Apng);
    if moving && !arguments.at.is_empty() {
        let diagnostic = Diagnostic::error("cannot-draw", "--at shows one pose, GIF and APNG move");
        return Err(Failure::Usage(
            diagnostic.help("leave out --at, or write .svg, .png or .dxf"),
        ));
    }
    if moving && arguments.dimensions {
        let message = "--dimensions shows one pose, GIF and APNG move";
        let diagnostic = Diagnostic::error("cannot-draw", message);
        return Err(Failure::Usage(
            diagnostic.help("leave out --dimensions, or write .svg, .png or .dxf"),
        ));
    }
    if moving {
        let (view, frames, period) = motion(model, arguments.forces, speaker)?;
        let stage = Stage::new(&view, &frames, options);
        let film = AnimationOptions {
            width: arguments.width,
            period,
            theme,
            ..AnimationOptions::default()
        };
        return match kind {
            Kind::Gif => animation::gif(&stage, &film),
            _ => animation::apng(&stage, &film),
        }
        .map_err(failed);
    }
    let (mut view, frames, shown) = pose(arguments, model, speaker)?;
    if arguments.dimensions {
        view.dimensions = dimensions(model, &view);
        let sizes = view.dimensions.len();
        if sizes > MOST_SIZES && kind != Kind::Dxf {
            let message = format!(
                "{sizes} sizes are more than the picture has room for: some may lie over each other or beyond its edge"
            );
            let diagnostic = Diagnostic::warning("crowded-picture", message);
            speaker.tell(&[diagnostic
                .help("write a .dxf, whose layer DIMENSIONS can be enlarged, or look them up with `kempe check`")]);
        }
    }
    let stage = Stage::new(&view, &frames, options);
    match kind {
        Kind::Dxf => Ok(dxf::document(&stage, shown).into_bytes()),
        Kind::Png => {
            let [width, _] = stage.size();
            raster::png(
                &stage.scene(shown),
                theme,
                f64::from(arguments.width) / width * 25.4,
            )
            .map_err(failed)
        }
        _ => Ok(svg::document(&stage.scene(shown), theme).into_bytes()),
    }
}

/// The first study of motion, or with `forces` of forces; where there is none, what the drives do on the way of any study.
fn first_study(model: &Model, forces: bool) -> Option<Study> {
    let wanted = |study: &&Study| {
        matches!(
            (&study.kind, forces),
            (StudyKind::Motion(_), false) | (StudyKind::Forces(_), true)
        )
    };
    if let Some(study) = model.studies.iter().find(wanted) {
        return Some(study.clone());
    }
    let any = model.studies.first()?;
    let along = MotionStudy {
        columns: Vec::new(),
        plots: Vec::new(),
        circuit: false,
        ..any.kind.along().clone()
    };
    Some(Study {
        kind: if forces {
            StudyKind::Forces(along)
        } else {
            StudyKind::Motion(along)
        },
        ..any.clone()
    })
}

/// All poses of the first study, and how long one pass should take on the screen, s.
fn motion(
    model: &Model,
    forces: bool,
    speaker: &mut Speaker,
) -> Result<(MechanismView, Vec<Frame>, f64), Failure> {
    // What moves by itself moves as it does there; the drives' own laws would show something else, or nothing.
    let by_itself = |s: &&Study| match s.kind {
        StudyKind::Simulate(_) | StudyKind::Contact(_) => true,
        StudyKind::Vibrations(_) => !forces,
        _ => false,
    };
    let first = model.studies.first().filter(by_itself).cloned();
    let Some(study) = first.or_else(|| first_study(model, forces)) else {
        return Err(Failure::Usage(nothing_to_run()));
    };
    room_for(model, &study).map_err(Failure::TooLarge)?;
    interrupt::listen();
    let result = kempe_study::run(model, &study, &mut Bar::new(&study.name, false))
        .map_err(Failure::Unsolved)?;
    if result.interrupted() {
        return Err(Failure::Interrupted);
    }
    speaker.tell(&drawn_all_the_same(&result.diagnostics));
    let real = result
        .table
        .column("time")
        .and_then(|c| c.values.last().copied());
    // Real time where that can be with_progress.
    let period = real
        .filter(|t| (1.0..=20.0).contains(t))
        .unwrap_or(AnimationOptions::default().period);
    // Where modes are asked for the first moves.
    let frames = match result.shapes.first() {
        Some(mode) => (mode.frames.iter())
            .map(|frame| drawn(model, frame, mode.title.clone()))
            .collect(),
        None => drawing_frames(model, &result),
    };
    Ok((
        mechanism_view(model, Some(study.kind.along())),
        frames,
        period,
    ))
}

/// What keeps the motion from going as far as it should keeps no picture from being drawn: it is a warning here.
fn drawn_all_the_same(diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
    let warning = |d: &Diagnostic| d.clone().with_severity(Severity::Warning);
    diagnostics.iter().map(warning).collect()
}

/// The pose asked for, in front of the paths of the first study where that runs.
fn pose(
    arguments: &Draw,
    model: &Model,
    speaker: &mut Speaker,
) -> Result<(MechanismView, Vec<Frame>, usize), Failure> {
    let texts = arguments.at.iter().map(String::as_str);
    let settings = Setting::all(model, texts).map_err(Failure::Usage)?;
    let posed = match arguments.forces {
        true => loaded_at(model, &settings),
        false => pose_at(model, &settings),
    };
    let posed = posed.map_err(Failure::Unsolved)?;
    speaker.tell(&drawn_all_the_same(&posed.diagnostics));
    let mut frames = Vec::new();
    let study = first_study(model, arguments.forces);
    if let Some(study) = &study {
        match kempe_study::run(model, study, &mut kempe_study::Silent) {
            Ok(result) => {
                speaker.tell(&drawn_all_the_same(&result.diagnostics));
                frames = drawing_frames(model, &result);
            }
            Err(errors) => speaker.tell(&drawn_all_the_same(&errors)),
        }
    }
    let pose = drawn(model, &posed.frame, posed.label);
    let shown = place_among(&frames, &pose).unwrap_or_else(|| {
        // Off the motion. Behind a pose that is nowhere, so that no path runs on to it.
        frames.push(Frame::default());
        frames.len()
    });
    frames.insert(shown, pose);
    let along = study.as_ref().map(|s| s.kind.along());
    Ok((mechanism_view(model, along), frames, shown))
}

/// Where in a motion a pose belongs: between the two poses where it is no detour. Nowhere when it is not on the motion.
fn place_among(frames: &[Frame], pose: &Frame) -> Option<usize> {
    let apart = |a: &Frame, b: &Frame| -> f64 {
        let pairs = a.points.iter().zip(&b.points);
        pairs
            .map(|(p, q)| (p[0] - q[0]).abs() + (p[1] - q[1]).abs())
            .sum()
    };
    let detour = |pair: &[Frame]| match pair {
        [before, after] => apart(before, pose) + apart(pose, after) - apart(before, after),
        _ => f64::INFINITY,
    };
    let (at, pair) =
        (frames.windows(2).enumerate()).min_by(|a, b| detour(a.1).total_cmp(&detour(b.1)))?;
    let step = match pair {
        [before, after] => apart(before, after),
        _ => return None,
    };
    (detour(pair) <= step).then_some(at + 1)
}
