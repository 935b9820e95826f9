//! Long chains: condition numbers that grow as the fourth power of the number of joints.

use articulated_core::algorithm::FunctionId;
use articulated_core::algorithm::checked::Factor;
use articulated_core::description::Base;
use articulated_core::model::Model;

use super::Effort;
use crate::stress::judge::{BACKWARD, Ends, Judge, call};
use crate::stress::robots::{Shape, built, chain, state};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "chains";

const WHY: &str = "the mass matrix of N alike rods in a row has a condition number of some 3.9 N⁴";

pub(super) fn rows(effort: Effort) -> Vec<Row> {
    let lengths: &[usize] = if effort == Effort::Full { &[2, 4, 8, 16, 32, 64, 128, 256] } else { &[2, 8, 32, 100] };
    let mut rows = Vec::new();
    for &n in lengths {
        for shape in [Shape::Straight, Shape::Folded, Shape::ZigZag] {
            rows.extend(one(n, shape, 1.0));
        }
    }
    for n in [8, 16, 25] {
        rows.extend(one(n, Shape::Straight, 0.5));
    }
    rows.extend(long(if effort == Effort::Full { 1000 } else { 300 }));
    rows
}

fn one(n: usize, shape: Shape, ratio: f64) -> Vec<Row> {
    let tapering = ratio != 1.0;
    let name = if tapering { format!("{n} rods, each half as long as the one before") } else { format!("{n} rods, {}", shape.name()) };
    let why =
        if tapering { "masses fall by 8 and lengths by 2 from link to link, so that κ(M) grows as 32 to the number of rods" } else { WHY };
    let case = Case::new(NAME, name, why);
    let model = built(&chain(n, ratio), Base::Fixed);
    let states = [state(shape.angles(n), n, 1, 10.0), state(shape.angles(n), n, 2, 1e-3)];
    let mut rows = Vec::new();
    let small = n <= 8;
    let double = Judge::<f64>::new(&case, &model);
    rows.extend(double.forward(&states[..1], small));
    rows.extend(double.solved(&states, Ends::Solved, BACKWARD));
    let single = Judge::<f32>::new(&case, &model);
    rows.extend(single.forward(&states[..1], small));
    rows.extend(single.solved(&states, if n < 30 && !tapering { Ends::Solved } else { Ends::Either }, BACKWARD));
    if shape == Shape::Straight && !tapering && n >= 8 {
        let law = 3.9 * (n as f64).powi(4);
        rows.push(case.between("κ₂(M) over 3.9 N⁴, f64", condition(&model, &states[0].q) / law, [0.5, 2.0], ""));
    }
    rows
}

/// Linear in the number of joints: recursions alone.
fn long(n: usize) -> Vec<Row> {
    let case = Case::new(
        NAME,
        format!("{n} rods, zig-zag, recursions"),
        "a thousand joints: no matrix is formed, errors may still add up from joint to joint",
    );
    let model = built(&chain(n, 1.0), Base::Fixed);
    let states = [state(Shape::ZigZag.angles(n), n, 3, 10.0)];
    let judge = Judge::<f64>::new(&case, &model);
    judge.recursions(&states)
}

/// κ₂ by power iteration, with M and with M⁻¹.
fn condition(model: &Model<f64>, q: &[f64]) -> f64 {
    let (n, m) = (model.nv, call(FunctionId::mass_matrix, model, &[q.to_vec()]));
    let mut factor = Factor::<f64>::new(n);
    let _ = factor.factor(&m);
    let product = |x: &mut Vec<f64>| *x = (0..n).map(|i| m[i * n..][..n].iter().zip(x.iter()).map(|(m, x)| m * x).sum()).collect();
    largest(n, product) * largest(n, |x| factor.solve(x))
}

fn largest(n: usize, apply: impl Fn(&mut Vec<f64>)) -> f64 {
    let mut x: Vec<f64> = (0..n).map(|k| 1.0 + 0.3 * ((k * 7) % 5) as f64 * if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
    let mut size = 1.0;
    for _ in 0..40 {
        apply(&mut x);
        size = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        x.iter_mut().for_each(|x| *x /= size);
    }
    size
}
