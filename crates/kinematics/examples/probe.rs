//! Prints rows of a model file's measures: `probe FILE STEP [COUNT]`.
use kempe_kinematics::*;
use kempe_model::Model;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).expect("file");
    let checked = match Model::from_toml(&text, &args[1], &mut |_| Err("no".into())) {
        Ok(c) => c,
        Err(list) => {
            for d in list {
                println!("{}", d.render_plain(&args[1], &text));
            }
            return;
        }
    };
    let model = checked.model;
    let mechanism = Mechanism::new(&model);
    let plan = Plan::new(&mechanism);
    for step in &plan.steps {
        println!(
            "  {}",
            format!("{step:?}").chars().take(60).collect::<String>()
        );
    }
    let parameters: Vec<f64> = model.parameter_values();
    let design = Design::new(&mechanism, &plan, &parameters);
    let f = check(&mechanism, &plan, &design, &parameters);
    println!("mobility {:?}", f.mobility);
    for g in &f.groups {
        println!(
            "group {} {} {:?}",
            g.class,
            g.kind,
            g.bodies
                .iter()
                .map(|b| mechanism.body_name(*b))
                .collect::<Vec<_>>()
        );
    }
    for b in &f.four_bars {
        println!(
            "fourbar {:?} {:?}",
            b.bodies.map(|b| mechanism.body_name(b)),
            b.kind
        );
    }
    println!(
        "reach {:?} idle {:?} redundant {:?}",
        f.reach
            .map(|r| (r.range, r.ends, r.full_turn, r.events.len())),
        f.idle,
        f.redundant
    );
    let t0 = std::time::Instant::now();
    let motion = match Motion::new(&mechanism, &plan, &design, &parameters) {
        Ok(m) => m,
        Err(e) => {
            println!(
                "ERROR {}",
                format!("{e:?}").chars().take(600).collect::<String>()
            );
            return;
        }
    };
    println!(
        "motion {:?} nodes {} reached {:?} demanded {:?} ends {:?} assemblies {} (+{}) complete {} paths {:?}",
        t0.elapsed(),
        motion.nodes(),
        motion.reached(),
        motion.demanded,
        motion.ends,
        motion.assemblies.list.len(),
        motion.assemblies.rejected,
        motion.assemblies.complete,
        motion.assemblies.paths
    );
    for e in &motion.events {
        println!(
            "  event {:?} at {:.17} deg {:.16} steps {:?}",
            e.kind,
            e.at,
            e.at.to_degrees(),
            e.steps
        );
    }
    if let Ok(c) = circuit::Circuit::new(&mechanism, &plan, &design, &parameters) {
        println!(
            "circuit closed {} length {:.4} stretches {:?}",
            c.closed,
            c.length,
            c.stretches
                .iter()
                .map(|s| (s.motion.reached(), s.forward))
                .collect::<Vec<_>>()
        );
    }
    let measures: Vec<_> = model.measures.iter().map(|m| &m.measure).collect();
    let t0 = std::time::Instant::now();
    let mut sampler = match Sampler::new(&motion, &measures) {
        Ok(s) => s,
        Err(e) => {
            println!("ERROR {e:?}");
            return;
        }
    };
    println!("sampler {:?}", t0.elapsed());
    for v in &args[2..] {
        let mut p: f64 = v.parse().expect("number");
        if motion.path.coordinates_are_angles() {
            p = p.to_radians();
        }
        let s = sampler.at_parameter(p);
        println!(
            "p={v} t={} closure {:.1e} sigma {:.3e} {:?}",
            s.time, s.closure, s.smallest_singular_value, s.note
        );
        if args.len() == 3 {
            for (l, x) in model.links.iter().zip(&s.links) {
                println!(
                    "    link {:8} {:.6} {:.6} {:.6}",
                    l.name,
                    x[0],
                    x[1],
                    x[2].to_degrees()
                );
            }
        }
        for (m, x) in model.measures.iter().zip(&s.values) {
            let deg = m.dimension == kempe_units::Dimension::ANGLE;
            println!(
                "    {:8} {:.15}",
                m.name,
                if deg { x.to_degrees() } else { *x }
            );
        }
    }
}
