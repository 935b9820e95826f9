//! The plot of the chapter "Linear time": operations of the library against the number of joints.
//!
//! `UPDATE_GOLDEN=1 cargo test -p articulated-book --test linear_time` draws it anew.

use std::path::Path;

use articulated::algorithm::{articulated_body, inverse_dynamics, mass_matrix};
use articulated::{Dynamics, Model};
use articulated_book::{Counted, Robot, chain, count, robot};
use articulated_lab::plot::{Anchor, Axis, Drawing, INK, SMALL, Text};

const LENGTHS: [usize; 10] = [1, 2, 4, 8, 15, 30, 60, 125, 250, 500];
const NAMES: [(&str, &str); 3] =
    [("CRBA: mass matrix", "#b5541c"), ("ABA: forward dynamics", "#1b6ca8"), ("RNEA: inverse dynamics", "#3a7d2c")];
const ROBOTS: [&str; 3] = ["simple_pendulum", "golfer", "humanoid"];

/// Operations of CRBA, ABA and RNEA.
fn operations(of: &Robot) -> [f64; 3] {
    let model: Model<Counted> = of.model.cast();
    let (mut ws, nv) = (model.workspace(), of.model.nv());
    let numbers = |x: &[f64]| x.iter().map(|&x| Counted(x)).collect::<Vec<_>>();
    let state = of.state(1);
    let [q, v, a] = [&state.q, &state.v, &state.a].map(|x| numbers(x));
    let (mut vector, mut matrix) = (vec![Counted(0.0); nv], vec![Counted(0.0); nv * nv]);
    [
        count(|| mass_matrix(&model, &mut ws, &q, &mut matrix)),
        count(|| articulated_body(&model, &mut ws, &q, &v, &a, &mut vector)),
        count(|| inverse_dynamics(&model, &mut ws, &q, &v, &a, &mut vector)),
    ]
    .map(|n| n as f64)
}

fn drawing(counts: &[(f64, [f64; 3])], robots: &[(f64, [f64; 3])]) -> String {
    let (left, right, top, bottom) = (80.0, 560.0, 84.0, 400.0);
    let mut out = Drawing::new(580.0, 450.0);
    let joints = Axis::logarithmic(counts.iter().map(|c| c.0), [left, right], 0.05);
    let axis = Axis::logarithmic(counts.iter().flat_map(|c| c.1).chain([50.0]), [bottom, top], 0.05);
    out.write(Text::new([left, 18.0], Anchor::Start, 14.0, INK, "Operations of one call against the number of joints").bold());
    for (k, (name, colour)) in NAMES.iter().enumerate() {
        out.key([left + 165.0 * k as f64, 38.0], (colour, None), INK, name);
    }
    out.key([left, 54.0], ("#999999", Some([4.0, 4.0])), INK, "slope 1");
    out.key([left + 165.0, 54.0], ("#999999", Some([1.5, 3.0])), INK, "slope 2");
    out.ring([left + 339.0, 54.0], 4.0, INK);
    out.text([left + 350.0, 58.0], Anchor::Start, SMALL, INK, "the robot named below");
    out.ticks_below(&joints, &joints.decades(|n| format!("{n}")), [top, bottom]);
    out.ticks_beside(&axis, &axis.decades(|n| format!("{n}")), [left, right]);
    out.text([(left + right) / 2.0, 440.0], Anchor::Middle, SMALL, INK, "joints");
    out.write(Text::new([16.0, (top + bottom) / 2.0], Anchor::Middle, SMALL, INK, "additions, multiplications, divisions, sines").turned());
    // Through the longest chain: at half of RNEA's count for slope 1, and at CRBA's for slope 2.
    let (n, [crba, _, rnea]) = counts[counts.len() - 1];
    let slopes = [(1.0, rnea * 0.5, 1.0, [4.0, 4.0]), (2.0, crba * 1.7, 30.0, [1.5, 3.0])];
    for (slope, end, from, dash) in slopes {
        let at = |x: f64| [joints.at(x), axis.at(end * (x / n).powf(slope))];
        out.line(vec![at(from), at(n)], "#999999", 1.2, Some(dash));
    }
    for (k, (_, colour)) in NAMES.iter().enumerate() {
        out.line(counts.iter().map(|(n, c)| [joints.at(*n), axis.at(c[k])]).collect(), colour, 2.0, None);
        robots.iter().for_each(|(n, c)| out.ring([joints.at(*n), axis.at(c[k])], 4.0, colour));
    }
    for ((n, _), name) in robots.iter().zip(["pendulum: 1", "golfer: 15", "humanoid: 30"]) {
        let x = joints.at(*n);
        out.line(vec![[x, top], [x, bottom]], "#bbbbbb", 1.0, None);
        let (at, anchor) = if *n == 15.0 { (x - 4.0, Anchor::End) } else { (x + 4.0, Anchor::Start) };
        out.write(Text::new([at, bottom - 8.0], anchor, SMALL, INK, name).rimmed());
    }
    out.svg()
}

#[test]
fn the_plot_is_that_of_the_library() {
    let counts: Vec<(f64, [f64; 3])> = LENGTHS.map(|n| (n as f64, operations(&chain(n)))).to_vec();
    // The humanoid's floating base is beside its 30 joints.
    let robots: Vec<(f64, [f64; 3])> = ROBOTS.iter().zip([1.0, 15.0, 30.0]).map(|(name, n)| (n, operations(&robot(name)))).collect();
    // Per joint, RNEA and ABA settle; CRBA grows.
    let [near, far] = [&counts[6], &counts[9]].map(|(n, c)| c.map(|c| c / n));
    assert!((far[2] / near[2] - 1.0).abs() < 0.02 && (far[1] / near[1] - 1.0).abs() < 0.02, "{near:?} {far:?}");
    assert!(far[0] > 4.0 * near[0], "{near:?} {far:?}");

    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/linear-time.svg");
    let svg = drawing(&counts, &robots);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &svg).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == svg, "linear-time.svg is not the plot of these counts; UPDATE_GOLDEN=1 draws it anew: {counts:?} {robots:?}");
}
