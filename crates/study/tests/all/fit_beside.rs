//! Fits whose best designs lie where something ends: a change point, or a dead point at the start.
#![allow(clippy::unwrap_used)]

use crate::read::read;
use crate::told::scalar;
use kempe_study::{Silent, StudyResult, run};

/// A four-bar, led down from its own dimensions in inches, its pivot tilted by 10 deg or as it is told.
fn led(own: [f64; 8], tilt: Option<f64>, places: &str, timing: &str) -> StudyResult {
    let [a, b, c, px, py, d, ox, oy] = own;
    let varied = if tilt.is_some() {
        ", tilt = ['-90 deg', '90 deg']"
    } else {
        ""
    };
    let tilt = tilt.unwrap_or(10.0);
    let model = read(&format!(
        "units = {{ length = 'in', angle = 'deg' }}\n[parameters]\na = '{a} in'\nb = '{b} in'\nc = '{c} in'\npx = '{px} in'\npy = '{py} in'\n\
         d = '{d} in'\nox = '{ox} in'\noy = '{oy} in'\ntilt = '{tilt} deg'\n[links]\n\
         frame = {{ A = ['ox', 'oy'], D = ['ox + d*cos(tilt)', 'oy + d*sin(tilt)'] }}\ncrank = {{ A-B = 'a' }}\n\
         coupler = {{ B-C = 'b', P = ['px', 'py'] }}\nrocker = {{ D-C = 'c' }}\n[drives]\n\
         motor = {{ turns = 'crank', from = 40, to = 200, law = 'cycloidal', in = '2 s' }}\n[assembly]\nC = 'right of B -> D'\n\
         [studies.go]\nkind = 'motion'\n[studies.best]\nkind = 'optimize'\nover = 'go'\nmethod = 'local'\n\
         vary = {{ a = ['0.5 in', '1.5 in'], b = ['1 in', '4 in'], c = ['1 in', '4 in'], px = ['-2 in', '3 in'], py = ['-2 in', '2 in'], \
         d = ['1 in', '4 in'], ox = ['-3 in', '3 in'], oy = ['-3 in', '3 in']{varied} }}\n\
         fit = {{ point = 'P', to = {places}, timing = '{timing}' }}\n"
    ));
    run(&model, &model.studies[1], &mut Silent).unwrap()
}

/// Exactly at the change point the motion folds over, and the fit is 0.64; beside it the best is above 0.84 (by a search of one's own over all eight).
#[test]
fn a_fit_is_no_design_alone_at_a_change_point() {
    let own = [
        1.486893, 1.3502, 1.137205, 0.931304, 1.374724, 1.000359, -0.60667, -0.187257,
    ];
    let places =
        "[[0,-1],[0.4,-0.7],[0.6,-0.2],[0.5,0.4],[0.1,0.9],[-0.6,1.2],[-1.5,1.0],[-1.8,0.7]]";
    let result = led(own, None, places, "even");
    let square = scalar(&result, "sum of squares");
    assert!(square > 0.83 && square < 0.8542, "{square}");
}

/// Where the drive starts at a dead point slopes are without bound: no slope beside it counted in their size, and the design was said to be an optimum where
/// 0.04 in away there is a better one, 0.00319.
#[test]
fn a_fit_that_starts_at_a_dead_point_is_no_optimum_by_its_slopes_alone() {
    let own = [
        0.786_265_443_752_261_3,
        3.465_229_634_682_385,
        0.093_792_829_248_061_62 / 0.0254,
        -0.003_591_487_204_406_787_5 / 0.0254,
        0.047_683_461_368_894_44 / 0.0254,
        1.000_000_000_000_219_6,
        -1.299_211_255_493_095,
        0.006_190_893_905_994_935 / 0.0254,
    ];
    let places = "[[0,-1],[0.4,-0.7],[0.6,-0.2],[0.5,0.4],[0.1,0.9],[-0.6,1.2]]";
    let result = led(own, Some(34.981_223_486_019), places, "arc-length");
    let square = scalar(&result, "sum of squares");
    let is_open = result.diagnostics.iter().any(|d| d.code == "not-converged");
    assert!(
        square < 0.003_19 || is_open,
        "{square} {:?}",
        result.diagnostics
    );
}

/// A drive that comes back has each value twice; where another stands elsewhere then, places are met the first time, which is told.
#[test]
fn values_that_a_drive_has_again_are_told() {
    let text = |law: &str| {
        format!(
            "units = {{ length = 'mm', angle = 'deg' }}\n[parameters]\nl = '100 mm'\n[links]\nframe = {{ A = [0, 0] }}\narm = {{ A-B = 'l' }}\n\
             rod = {{ B-P = 80 }}\n[drives]\n\
             hip = {{ turns = 'arm', from = 0, law = [{{ rise = 60, in = '1 s' }}, {{ rise = -60, in = '1 s' }}] }}\n\
             knee = {{ turns = 'rod', from = 0, law = [{law}] }}\n[studies.go]\nkind = 'motion'\nrows = 9\n[studies.best]\nkind = 'optimize'\n\
             over = 'go'\nmethod = 'local'\nvary = {{ l = ['50 mm', '150 mm'] }}\n\
             fit = {{ point = 'P', to = [[150, 60], [140, 80]], timing = {{ hip = [20, 30] }} }}\n"
        )
    };
    let rests = "{ dwell = '1 s' }, { rise = 40, in = '1 s' }";
    let with = "{ rise = 40, in = '1 s' }, { rise = -40, in = '1 s' }";
    for (law, told) in [(rests, 1), (with, 0)] {
        let model = read(&text(law));
        let result = run(&model, &model.studies[1], &mut Silent).unwrap();
        let again = result
            .diagnostics
            .iter()
            .filter(|d| d.code == "passed-again");
        assert_eq!(again.count(), told, "{:?}", result.diagnostics);
    }
}
