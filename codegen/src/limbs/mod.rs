//! Limbs in lanes: branches of a robot that are alike are one program on vectors, one branch a lane.
//!
//! ```text
//! Model → (alike branches) → Model of symbols, one for each constant that differs → trace → pack → Graph of vectors
//! ```
//!
//! The whole robot is traced, so that the algorithms know nothing of lanes. What differs between branches are then different inputs and different
//! constants, which stay symbols while tracing, and so each branch leaves the same trace; [`pack`] lays one on the other.

mod alike;
mod pack;

pub(crate) use alike::{Alike, Constants};
pub(crate) use pack::pack;

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::functions;
    use articulated_core::description::Base;

    use super::*;
    use crate::graph::{Counts, Graph, Op};
    use crate::pass::GRAPH_PASSES;
    use crate::trace::{Choice, trace, trace_in_lanes, ways};
    use crate::{Request, Sym, Wanted};

    #[test]
    fn probe() {
        for (name, width) in [("quadruped", 4), ("quadruped", 2), ("humanoid", 2)] {
            let urdf = std::fs::read(format!("../models/urdf/{name}.urdf")).unwrap();
            let mut request = Request::new(name, urdf);
            request.options.base = Base::Floating;
            request.options.allow_unphysical_inertia = true;
            let model = crate::model(&request, &crate::read(&request).unwrap().description).unwrap();
            let alike = Alike::of(&model, width).unwrap();
            for f in functions::<Sym>() {
                if name == "humanoid" && f.name.contains("forward_dynamics_deriv") {
                    continue;
                }
                let wanted = Wanted::parse(f.name).unwrap();
                for (way, _) in ways(&wanted.parts[0], &model) {
                    let choice = [Choice { way, passes: 1 }];
                    let run = |g: Graph| {
                        GRAPH_PASSES
                            .iter()
                            .fold(g, |g, (n, _pass, _)| if *n == "live" { crate::pass::live(&g) } else { crate::pass::contract(&g) })
                    };
                    let scalar = run(trace(&wanted, &choice, &model, &[]));
                    let packed = run(trace_in_lanes(&wanted, &choice, &model, &alike));
                    packed.verify().unwrap();
                    let input = |a: usize, k: usize| ((a * 7919 + k * 104_729 + 13) as f64 * 0.754_877_666_246_692_7).fract() - 0.4;
                    let (x, y) = (scalar.evaluate(input), packed.evaluate(input));
                    let worst = x.iter().zip(&y).map(|(a, b)| (a - b).abs() / (1.0 + a.abs())).fold(0.0, f64::max);
                    let c = |c: Counts| c.instructions();
                    let p = packed.counts();
                    println!(
                        "{name} {width} {:40} {:10} {:6} -> {:6} spread {:5} across {:4} sin {:3} in {:3} worst {worst:.1e}",
                        f.name,
                        way.name,
                        c(scalar.counts()),
                        c(p.clone()),
                        p.of(Op::Spread),
                        p.of(Op::Across),
                        p.of(Op::Sin),
                        p.of(Op::LaneInput)
                    );
                }
            }
        }
    }
}
