//! Predicted size of generated code, from the kinematic tree alone, before tracing.
//!
//! A function with one number per joint grows linearly with the chain, one with a number per pair
//! of joints quadratically, and one that inverts the mass matrix cubically. A test compares
//! predictions with generated code.

use std::collections::BTreeSet;

use articulated_core::algorithm::{FunctionId, Group, Shape};
use articulated_core::constraint::Pair;
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics};
use articulated_core::index::{BodyId, ById};
use articulated_core::model::Model;

use crate::function_spec::{Derivative, FunctionSpec, FunctionTerm};
use crate::limbs::{self, IsomorphicLimbs};
use crate::{Options, Request, program};

/// Default limit of generated source, megabytes (10⁶ bytes). For more, a compiler takes minutes and
/// gigabytes of memory, and loops over joints are faster.
pub const MAX_CODE_SIZE: u64 = 64;

/// Bytes of source per instruction.
pub(crate) struct Bytes {
    /// Of the function of one state.
    pub(crate) single: f64,
    /// More of it where isomorphic limbs are lanes of vectors.
    pub(crate) limbs: f64,
    /// Of the functions of many states: of all types of numbers together, and of each type.
    pub(crate) states: [f64; 2],
}

/// Properties of a tree that determine the code size of a function.
struct Tree {
    bodies: f64,
    frames: f64,
    freedoms: f64,
    /// Pairs of a degree of freedom and one on its path to the root, itself included.
    pairs: f64,
    /// Sum of the squares of the number of degrees of freedom on the path to the root, over all
    /// degrees of freedom.
    squares: f64,
    /// Pairs of a frame and a degree of freedom that moves it.
    frame_pairs: f64,
    /// As `squares`, over all frames.
    frame_squares: f64,
    /// Whether there are mimic joints: then forward dynamics factorises the mass matrix.
    has_followers: bool,
    /// Instructions of the accelerations with constraints.
    constraints: f64,
}

impl Tree {
    fn of(model: &Model<f64>) -> Self {
        let mut depths: ById<BodyId, f64> = ById::default();
        let (mut freedoms, mut pairs, mut squares) = (0.0, 0.0, 0.0);
        for (i, body) in model.bodies().with_ids() {
            if i == BodyId::BASE {
                depths.push(0.0);
                continue;
            }
            let (below, own) = (depths[body.parent], body.joint.nv());
            for k in 1..=own {
                let depth = below + k as f64;
                (pairs, squares) = (pairs + depth, squares + depth * depth);
            }
            freedoms += own as f64;
            depths.push(below + own as f64);
        }
        let of_frames = model.frames().iter().map(|frame| depths[frame.body]);
        Self {
            bodies: model.bodies().len() as f64,
            frames: model.frames().len() as f64,
            freedoms,
            pairs,
            squares,
            frame_pairs: of_frames.clone().sum(),
            frame_squares: of_frames.map(|depth| depth * depth).sum(),
            has_followers: model.has_followers(),
            constraints: constraints(model),
        }
    }

    /// How many times as many instructions a derivative has, about.
    fn times(&self, spec: &FunctionSpec, shape: Shape) -> f64 {
        let Some(transform) = &spec.transform else { return 1.0 };
        let inputs: usize = transform.wrt.iter().map(|a| transform.dims(*a).iter().map(|d| d.len(shape)).product::<usize>()).sum();
        let outputs = spec.parts[0].function.len(shape);
        match transform.kind {
            Derivative::Vjp | Derivative::Jvp | Derivative::Gradient => 2.5,
            Derivative::Hvp => 6.0,
            Derivative::Jacobian => 1.0 + 0.5 * inputs.min(outputs) as f64,
            Derivative::Hessian => 2.5 + 0.5 * inputs as f64,
        }
    }

    /// Instructions of one function; `columns`: whether the solution of M X = B is a loop.
    fn instructions(&self, part: &FunctionTerm, columns: bool) -> f64 {
        let factors = 0.5 * self.squares;
        let inverse = self.freedoms * self.pairs;
        let of = |function: FunctionId| match function.row::<f64>().general.name() {
            "mass_matrix" => 20.0 * self.pairs,
            "coriolis_matrix" => 30.0 * self.pairs,
            "inverse_dynamics_derivatives_with_wrenches" => 55.0 * self.pairs,
            "static_torque_derivative" => 15.0 * self.pairs,
            "torque_regressor" => 70.0 * self.pairs,
            "mass_matrix_inverse" => 20.0 * self.pairs + inverse,
            "forward_dynamics_derivatives_with_wrenches" => 80.0 * self.pairs + if columns { factors } else { 5.0 * inverse },
            "forward_dynamics_with_wrenches" | "solve_mass_matrix" if self.has_followers => 20.0 * self.pairs + factors,
            "forward_dynamics_with_wrenches" | "solve_mass_matrix" => 150.0 * self.bodies,
            "operational_space_inertia" | "operational_space_inertia_inverse" => 20.0 * self.pairs + factors + 12.0 * self.frame_squares,
            "placement_derivatives" => 35.0 * self.frame_pairs,
            "jacobians_body" => 30.0 * self.frame_pairs,
            "jacobian_rates_body" => 55.0 * self.frame_pairs,
            "jacobians_world" | "jacobians_world_aligned" | "jacobian_rates_world" | "jacobian_rates_world_aligned" => {
                19.0 * self.frame_pairs
            }
            _ => 0.0,
        };
        let contains = part.function.contains;
        let own = if contains.is_empty() { of(part.function.id) } else { contains.iter().map(|id| of(*id)).sum() };
        let frames = if part.function.asks_for_frames() { self.frames } else { 0.0 };
        let constraints = match part.function.group {
            Group::Constraints if part.function.name.contains("rk4") => 4.0 * self.constraints,
            Group::Constraints | Group::GivenContacts => self.constraints,
            _ => 0.0,
        };
        own + constraints + 100.0 * self.bodies + 20.0 * frames
    }
}

/// Instructions of the accelerations with constraints: those of each pair of shapes, of each pair
/// of bodies that may touch, and of a factorisation in which such bodies are coupled.
fn constraints(model: &Model<f64>) -> f64 {
    let all = model.constraints();
    if all.is_empty() {
        return 0.0;
    }
    let moved = |body: BodyId| -> BTreeSet<usize> { model.freedoms_of(body).into_iter().collect() };
    let bodies_of = |pair: &Pair| pair.shapes.map(|shape| all.shapes[shape].body);
    let groups: BTreeSet<[BodyId; 2]> = all.pairs.iter().map(bodies_of).collect();
    let mut coupled: Vec<BTreeSet<usize>> = model.bodies().with_ids().map(|(body, _)| moved(body)).collect();
    let mut sum = 60.0 * all.pairs.len() as f64 + 40.0 * (all.limits.len() + all.friction.len() + all.sums.len()) as f64;
    // Code of each sort of pair is there once.
    let sorts: BTreeSet<([&str; 2], usize)> =
        all.pairs.iter().map(|pair| (pair.shapes.map(|shape| all.shapes[shape].form.name()), pair.dimension)).collect();
    sum +=
        sorts.iter().map(|(forms, _)| if forms[1] == "box" { [500.0, 4000.0][usize::from(forms[0] == "box")] } else { 300.0 }).sum::<f64>();
    for anchor in &all.anchors {
        let own: BTreeSet<usize> = anchor.bodies.into_iter().flat_map(moved).collect();
        let rows = if anchor.turns.is_some() { 6.0 } else { 3.0 };
        sum += rows * (30.0 * own.len() as f64 + 2.0 * (own.len() * own.len()) as f64);
        coupled.push(own);
    }
    for bodies in groups {
        let [first, second] = bodies.map(moved);
        let own: BTreeSet<usize> = first.symmetric_difference(&second).copied().collect();
        let is_pair = !bodies[0].is_base() && !bodies[1].is_base();
        sum += if is_pair { 550.0 + 1.5 * (own.len() * own.len()) as f64 } else { 800.0 };
        if is_pair {
            coupled.push(own);
        }
    }
    // Sets that share a degree of freedom are one.
    let mut merged: Vec<BTreeSet<usize>> = Vec::new();
    for mut set in coupled {
        let (touching, apart): (Vec<_>, Vec<_>) = merged.into_iter().partition(|other| !other.is_disjoint(&set));
        touching.into_iter().for_each(|mut other| set.append(&mut other));
        merged = apart;
        merged.push(set);
    }
    let cube = |n: usize| (n * n * n) as f64 / 6.0;
    sum + merged.iter().map(|set| cube(set.len()) + 3.0 * (set.len() * set.len()) as f64).sum::<f64>()
}

/// Predicted source of a function, megabytes.
fn megabytes(spec: &FunctionSpec, model: &Model<f64>, tree: &Tree, options: &Options) -> f64 {
    let can = options.target.capabilities(options);
    let bytes = options.target.bytes();
    let times = tree.times(spec, model.shape());
    let instructions = |columns| times * spec.parts.iter().map(|part| tree.instructions(part, columns)).sum::<f64>();
    let has_limbs = options.limbs && can.vectors && options.parameters.is_empty();
    let has_limbs = has_limbs
        && [4, 2].into_iter().any(|width| IsomorphicLimbs::of(limbs::completed(model, width).as_ref().unwrap_or(model), width).is_some());
    let single = bytes.single + if has_limbs { bytes.limbs } else { 0.0 };
    let [all, each] = bytes.states;
    let states = if can.states { all + each * options.batch.len() as f64 } else { 0.0 };
    (single * instructions(program::has_columns(spec, model, can)) + states * instructions(false)) / 1e6
}

/// Reports a request for more code than its limit: an error for each of the largest functions,
/// without which the rest is within it.
pub(crate) fn within_limit(request: &Request, model: &Model<f64>, entries: &[(usize, FunctionSpec)], log: &mut Diagnostics) {
    let (options, tree) = (&request.options, Tree::of(model));
    let mut sizes: Vec<(&(usize, FunctionSpec), f64)> =
        entries.iter().map(|entry| (entry, megabytes(&entry.1, model, &tree, options))).collect();
    sizes.sort_by(|a, b| b.1.total_cmp(&a.1));
    let most = options.max_code_size as f64;
    let mut rest: f64 = sizes.iter().map(|(_, size)| size).sum();
    for ((k, function), size) in sizes {
        if rest <= most {
            break;
        }
        rest -= size;
        let library: Vec<&str> = function.parts.iter().map(|part| part.function.name).collect();
        let found = format!("about {} MB of code for {} degrees of freedom", size.ceil() as u64, model.nv());
        let expected = format!(
            "at most {} MB for all functions together; call the library's {}, a loop over the joints, or allow more with `--max-code-size` \
             (key `max_code_size`, method `Build::max_code_size`)",
            options.max_code_size,
            library.join(" and ")
        );
        let error = Diagnostic::error(&request.file, (Default::default(), &function.name), Code::TooMuchCode, found, expected);
        log.push(error.at(&options.functions[*k]));
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::functions;
    use articulated_core::description::Base;

    use super::*;
    use crate::{Real, Sym, Target, generate};

    /// A link with mass, and a joint of this type that holds it.
    fn moved(name: usize, parent: usize, kind: &str) -> String {
        format!(
            "<link name='b{name}'><inertial><origin xyz='0.03 -0.01 0.04'/><mass value='0.4'/>\
             <inertia ixx='0.004' ixy='0.0002' ixz='0' iyy='0.005' iyz='-0.0001' izz='0.003'/></inertial></link>\
             <joint name='t{name}' type='{kind}'><parent link='b{parent}'/><child link='b{name}'/>\
             <origin xyz='0.02 0.01 0.07' rpy='0.2 -0.1 0.4'/><axis xyz='1 2 2'/></joint>"
        )
    }

    /// Joints with axes that meet no axis of coordinates, in chains of `row` joints from one link.
    fn chain(joints: usize, row: usize, base: Base) -> Request {
        let parent = |k: usize| if k % row == 1 { 0 } else { k - 1 };
        let trunk = "<link name='b0'><inertial><mass value='2'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.2' iyz='0' izz='0.15'/></inertial></link>";
        let links: String = (1..=joints).map(|k| moved(k, parent(k), "continuous")).collect();
        let mut request = Request::new("chain.urdf", format!("<robot name='chain'>{trunk}{links}</robot>"));
        (request.options.stages, request.options.robot.base) = (false, base);
        request
    }

    #[test]
    fn predictions_are_what_is_generated_within_a_factor_of_two() {
        let both = [Real::F64, Real::F32];
        let [rust, c] = Target::all();
        for (mut request, target, batch, limbs) in [
            (chain(24, 24, Base::Fixed), rust.clone(), 0, false),
            (chain(18, 6, Base::Floating), rust.clone(), 0, false),
            (chain(12, 12, Base::Fixed), rust, 1, false),
            (chain(24, 24, Base::Fixed), c.clone(), 0, false),
            (chain(12, 6, Base::Floating), c.clone(), 0, true),
            (chain(10, 10, Base::Fixed), c, 2, false),
        ] {
            (request.options.limbs, request.options.target) = (limbs, target);
            request.options.batch = both[..batch].to_vec();
            let whole = request.build_robot().unwrap().model;
            for function in functions::<Sym>() {
                request.options.functions = vec![function.name.into()];
                let Ok(generated) = generate(&request) else { continue };
                let spec = FunctionSpec::plain(function);
                let predicted = megabytes(&spec, &whole, &Tree::of(&whole), &request.options);
                let found = generated.source.len() as f64 / 1e6;
                // What is small is never refused, and mostly helpers that all modules have.
                let (language, name) = (request.options.target.name(), function.name);
                let is_close = found < predicted.max(0.5) * 2.0 && predicted < found.max(0.5) * 2.0;
                assert!(is_close, "{language} {name} {found} {predicted}");
            }
        }
    }

    #[test]
    fn code_beyond_the_limit_is_refused_before_it_is_traced() {
        let mut request = chain(1000, 1000, Base::Fixed);
        request.options.functions =
            ["inverse_dynamics", "mass_matrix", "other = coriolis_matrix", "forward_dynamics"].map(Into::into).to_vec();
        let start = std::time::Instant::now();
        let error = generate(&request).unwrap_err();
        assert!(start.elapsed().as_secs() < 5);
        let told = |function: &str, library: &str, size: u64| {
            format!(
                "chain.urdf: {function}: found about {size} MB of code for 1000 degrees of freedom, expected at most 64 MB for all functions together; \
                 call the library's {library}, a loop over the joints, or allow more with `--max-code-size` (key `max_code_size`, method \
                 `Build::max_code_size`)"
            )
        };
        let expected = [told("other", "coriolis_matrix", 998), told("mass_matrix", "mass_matrix", 668)].join("\n");
        assert_eq!(error.to_string(), expected);
        request.options.functions.retain(|f| !f.contains("matrix"));
        assert!(generate(&request).is_ok());
    }

    #[test]
    fn the_limit_is_that_of_the_request_and_of_all_functions_together() {
        let mut request = chain(40, 40, Base::Fixed);
        request.options.functions = vec!["mass_matrix".into(), "coriolis_matrix".into()];
        for (most, refused) in [(1, "coriolis_matrix"), (2, "coriolis_matrix"), (4, "")] {
            request.options.max_code_size = most;
            let told = generate(&request).map_or_else(|error| error.to_string(), |_| String::new());
            assert!(told.contains(refused), "{told}");
            assert_eq!(told.is_empty(), refused.is_empty(), "{told}");
            assert_eq!(told.contains("mass_matrix"), most == 1, "{told}");
        }
    }
}
