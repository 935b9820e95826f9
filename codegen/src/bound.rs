//! Guaranteed bounds on rounding errors of the functions that are emitted.

use articulated_core::algorithm::{Argument, coordinate_box};
use articulated_core::model::Model;
use articulated_core::running::Running;

use crate::graph::Graph;
use crate::{Arithmetic, Precision, TrigAccuracy};

/// Bounds of the difference between each result of a graph at a level and the same graph in real
/// arithmetic, for arguments within a radius of a midpoint: `input(argument, index)` is (midpoint,
/// radius). Infinite where a divisor may be zero or a choice may jump. `None` for levels whose
/// errors are of second order: they have no bound.
pub fn bounds(graph: &Graph, level: Precision, input: &dyn Fn(usize, usize) -> (f64, f64)) -> Option<Vec<f64>> {
    fn of<const BITS: u32, const SINES: u32>(graph: &Graph, bits: Option<u32>, input: &dyn Fn(usize, usize) -> (f64, f64)) -> Vec<f64> {
        let given = |argument: usize, k: usize| {
            let (value, radius) = input(argument, k);
            Running::<BITS, SINES>::within(value, radius)
        };
        let results = graph.evaluate_as(given);
        results.into_iter().map(|x| bits.map_or(x.error, |bits| x.rounded_to(bits))).collect()
    }
    let single = Some(24);
    Some(match (level.arithmetic, level.sines) {
        (Arithmetic::Compensated, _) => return None,
        (Arithmetic::DoubleDouble, _) => of::<102, 0>(graph, Some(53), input),
        (Arithmetic::Double, TrigAccuracy::Fast7) => of::<53, 7>(graph, None, input),
        (Arithmetic::Double, TrigAccuracy::Fast10) => of::<53, 10>(graph, None, input),
        (Arithmetic::Double, _) => of::<53, 0>(graph, None, input),
        (Arithmetic::SingleByDouble, TrigAccuracy::Fast7) => of::<53, 7>(graph, single, input),
        (Arithmetic::SingleByDouble, TrigAccuracy::Fast10) => of::<53, 10>(graph, single, input),
        (Arithmetic::SingleByDouble, _) => of::<53, 0>(graph, single, input),
        (Arithmetic::Single, TrigAccuracy::Fast7) => of::<24, 7>(graph, None, input),
        (Arithmetic::Single, TrigAccuracy::Fast10) => of::<24, 10>(graph, None, input),
        (Arithmetic::Single, _) => of::<24, 0>(graph, None, input),
    })
}

/// Bounds of all arguments in the box of
/// [`Generated::bounds_in_box`](crate::Generated::bounds_in_box): coordinates in their boxes
/// ([`coordinate_box`]), sines and cosines within ±1, everything else within ±2: (midpoint, radius)
/// of element `index`.
pub fn in_box(model: &Model<f64>, argument: Argument, index: usize) -> (f64, f64) {
    if !argument.is_configuration() {
        return if argument == Argument::SinCos { (0.0, 1.0) } else { (0.0, 2.0) };
    }
    let joint = model.joints().iter().find(|j| (j.q.0..j.q.0 + j.q.1).contains(&index));
    let (lower, upper) = joint.map_or((0.0, 0.0), |j| coordinate_box(j, index - j.q.0));
    // Halves: the sum may be beyond the range of numbers.
    (0.5 * lower + 0.5 * upper, 0.5 * upper - 0.5 * lower)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use articulated_core::description::Base;

    use super::*;
    use crate::Request;
    use crate::graph::Op;

    #[test]
    fn the_box_is_that_of_limits_of_quaternions_and_of_all_angles() {
        let joint = |name: &str, kind: &str, limit: &str| {
            format!(
                "<link name='{name}'/><joint name='{name}' type='{kind}'><parent link='trunk'/><child link='{name}'/><axis xyz='0 0 1'/>{limit}</joint>"
            )
        };
        let limit = "<limit lower='-1' upper='3' effort='1' velocity='1'/>";
        let model_with = |kind: &str| {
            let joints = joint("a", "revolute", limit) + &joint("b", kind, "");
            let mut request = Request::new("robot", format!("<robot name='robot'><link name='trunk'/>{joints}</robot>"));
            request.options.robot.base = Base::Floating;
            request.build_robot().unwrap().model
        };
        let mut model = model_with("continuous");
        for argument in [Argument::Q, Argument::Target] {
            let found: Vec<(f64, f64)> = (0..9).map(|k| in_box(&model, argument, k)).collect();
            assert_eq!(found, [[(0.0, 1.0); 7].as_slice(), &[(1.0, 2.0), (0.0, PI)]].concat());
        }
        assert_eq!([Argument::V, Argument::SinCos].map(|argument| in_box(&model, argument, 7)), [(0.0, 2.0), (0.0, 1.0)]);
        // The missing bound of a pair is one turn away, and bounds in the wrong order are swapped.
        for (lower, upper, expected) in [
            (f64::NEG_INFINITY, 3.0, (3.0 - PI, PI)),
            (3.0, -1.0, (1.0, 2.0)),
            (-f64::MAX, f64::MAX, (0.0, f64::MAX)),
            (1.0, f64::MAX, (0.5 * f64::MAX, 0.5 * f64::MAX)),
        ] {
            model = model.changed(|parts| {
                let limit = parts.joints[1].limit.as_mut().unwrap();
                (limit.lower, limit.upper) = (lower, upper);
            });
            assert_eq!(in_box(&model, Argument::Q, 7), expected);
        }
        // Lengths without limits are in ±1 m, and all angles of a joint that has several numbers in
        // ±π.
        let (prismatic, planar) = (model_with("prismatic"), model_with("planar"));
        assert_eq!(in_box(&prismatic, Argument::Q, 8), (0.0, 1.0));
        assert_eq!([8, 9, 10].map(|k| in_box(&planar, Argument::Q, k)), [(0.0, 1.0), (0.0, 1.0), (0.0, PI)]);
    }

    #[test]
    fn fewer_digits_have_larger_bounds() {
        let mut g = Graph::default();
        let (x, y) = (g.input(0, 0), g.input(0, 1));
        let sine = g.apply(Op::Sin, &[x]);
        g.outputs = vec![g.exactly(Op::Mul, &[sine, y])];
        let of = |arithmetic, sines| {
            bounds(&g, Precision { arithmetic, sines, ..Precision::default() }, &|_, k| ([0.7, 1.3][k], 0.0)).map(|b| b[0])
        };
        let all = [Arithmetic::Double, Arithmetic::SingleByDouble, Arithmetic::Single];
        for arithmetic in all {
            let [ulp, ten, seven] =
                [TrigAccuracy::Ulp1, TrigAccuracy::Fast10, TrigAccuracy::Fast7].map(|sines| of(arithmetic, sines).unwrap());
            // In single precision, an ulp-accurate sine is no more accurate than one of ten digits.
            let single = arithmetic == Arithmetic::Single;
            assert!(0.0 < ulp && ulp < seven && (single || ulp < ten) && ten < seven && seven < 1e-5, "{arithmetic:?} {ulp} {ten} {seven}");
        }
        let [double, rounded, single] = all.map(|arithmetic| of(arithmetic, TrigAccuracy::Ulp1).unwrap());
        let exact = of(Arithmetic::DoubleDouble, TrigAccuracy::DoubleDouble).unwrap();
        // Rounded to the nearest double, and to the nearest single: half a unit in the last place.
        assert!(
            4e-17 < exact && exact < double && double < 1e-15 && 1e-8 < rounded && rounded < single,
            "{exact} {double} {rounded} {single}"
        );
        assert_eq!(of(Arithmetic::Compensated, TrigAccuracy::DoubleDouble), None);
    }
}
