//! Reads a robot, prints its numbers for comparisons, and checks its regressor in some states:
//! `dynamics FILE GX GY GZ [KIND...]`. Elements of a KIND (`flex`, `composite`, `plugin`) are left
//! out.
//!
//! Standard input: states as little-endian doubles, q, v and a one after the other, until the end.
//! Standard output: one line of JSON, which describes the robot. If the file is refused, its errors
//! go to standard error, and the status is 1; also if inverse dynamics differs from the regressor
//! times the inertial parameters of the links.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{Read, Write};
use std::process::ExitCode;

use articulated_core::actuator::Filter;
use articulated_core::algorithm::{Workspace, inverse_dynamics, torque_regressor};
use articulated_core::description::{Base, Description, Origin};
use articulated_core::model::Model;
use articulated_formats::world::{Actuator, Keyframe, OnFrames, World};
use articulated_formats::{Disk, LeaveOut, MOST_BYTES, Options, Reading, read_file, read_with};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, rest @ ..] = arguments.as_slice() else {
        eprintln!("dynamics FILE GX GY GZ [KIND...]");
        return ExitCode::from(2);
    };
    let gravity: Vec<f64> = rest.iter().filter_map(|x| x.parse().ok()).collect();
    match run(file, &gravity, rest.iter().filter_map(|x| x.parse().ok()).collect()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(file: &str, gravity: &[f64], leave_out: BTreeSet<LeaveOut>) -> Result<(), String> {
    let bytes = read_file(file.as_ref(), MOST_BYTES).map_err(|error| format!("{file}: {error}"))?;
    let options = Options { file: file.to_owned(), leave_out, ..Options::default() };
    let reading = read_with(&Disk, &bytes, &options).map_err(|diagnostics| diagnostics.to_string())?;
    let model: Model<f64> = Model::new(&reading.description, Base::Fixed).map_err(|error| format!("{file}: {error}"))?;
    let model = match gravity {
        [x, y, z] => model.with_gravity([*x, *y, *z]),
        _ => model,
    };
    let mut out = std::io::stdout().lock();
    let fail = |error: std::io::Error| error.to_string();
    writeln!(out, "{}", header(&reading, &model)).map_err(fail)?;
    let mut input = Vec::new();
    std::io::stdin().read_to_end(&mut input).map_err(fail)?;
    let numbers: Vec<f64> = input.chunks_exact(8).map(|b| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]])).collect();
    let size = model.nq() + 2 * model.nv();
    let mut workspace = Workspace::new(&model);
    for state in numbers.chunks_exact(size.max(1)) {
        let (q, rest) = state.split_at(model.nq());
        let (v, a) = rest.split_at(model.nv());
        check_regressor(&model, &mut workspace, [q, v, a])?;
    }
    Ok(())
}

/// τ = Y π to twelve digits of the terms, and to the rounding of the accelerations in Y.
fn check_regressor(model: &Model<f64>, workspace: &mut Workspace<f64>, [q, v, a]: [&[f64]; 3]) -> Result<(), String> {
    let parameters = model.inertial_parameters().concat();
    let (mut torques, mut rows) = (vec![0.0; model.nv()], vec![0.0; model.nv() * parameters.len()]);
    inverse_dynamics(model, workspace, q, v, a, &mut torques);
    torque_regressor(model, workspace, q, v, a, &mut rows);
    let greatest = |all: &[f64]| all.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let accelerations = greatest(model.gravity().as_slice()) + greatest(v).powi(2) + greatest(a);
    let rounding = 1e-15 * accelerations * parameters.iter().map(|p| p.abs()).sum::<f64>();
    for (k, expected) in torques.iter().enumerate() {
        let terms = rows[k * parameters.len()..].iter().zip(&parameters).map(|(y, p)| y * p);
        let (found, size) = terms.fold((0.0, 0.0), |(sum, size): (f64, f64), term| (sum + term, size + term.abs()));
        if (found - expected).abs() > 1e-12 * size + rounding {
            let joint = model.joint_of(k);
            return Err(format!("torque_regressor: joint {joint:?}: found {found}, expected {expected} as inverse_dynamics has it"));
        }
    }
    Ok(())
}

fn header(reading: &Reading, model: &Model<f64>) -> String {
    let description = &reading.description;
    let mut out = format!("{{\"nq\": {}, \"nv\": {}, \"frames\": {}", model.nq(), model.nv(), model.frames().len());
    let warnings = list(&reading.warnings, |one| format!("{:?}", one.to_string()));
    let unused = list(&reading.unused, |one| format!("{:?}", one.to_string()));
    let _ = write!(out, ", \"warnings\": {warnings}, \"unused\": {unused}, \"links\": [");
    let links = description.links.iter().filter(|link| !link.intermediate);
    let links: Vec<String> = links.map(link_of).collect();
    let _ = write!(out, "{}], \"joints\": [", links.join(", "));
    let order = model.joints().iter().map(|joint| format!("[{:?}, {:?}, {}, {}]", joint.name, joint.kind.name(), joint.q.0, joint.v.0));
    let frames = model.frames().iter().map(|frame| format!("{:?}", frame.name));
    let [order, frames] = [order.collect::<Vec<_>>(), frames.collect()].map(|all| all.join(", "));
    let _ = write!(out, "{}], \"order\": [{order}], \"frame_names\": [{frames}]", joints(description));
    let _ = write!(out, ", \"world\": {}}}", world(&reading.world));
    out
}

fn list<T>(all: &[T], one: impl Fn(&T) -> String) -> String {
    format!("[{}]", all.iter().map(one).collect::<Vec<_>>().join(", "))
}

fn or_null<T: std::fmt::Debug>(value: Option<&T>) -> String {
    value.map_or("null".to_owned(), |value| format!("{value:?}"))
}

/// Pairs of a name and numbers, which JSON and Rust write in the same way, except brackets.
fn by_name(all: &[(String, Vec<f64>)]) -> String {
    list(all, |(name, numbers)| format!("[{name:?}, {numbers:?}]"))
}

/// The axes of a frame, row by row.
fn turn(at: &Origin) -> Vec<f64> {
    at.rotation.matrix::<f64>().transpose().iter().copied().collect()
}

fn world(world: &World) -> String {
    let actuators = |all: &[Actuator]| {
        list(all, |own| {
            let (name, drives, [gain, bias]) = (&own.name, by_name(&own.drives), [own.gain, own.bias]);
            // An infinite bound is `inf` in Rust, and `Infinity` in JSON as Python reads it.
            let range = |range: Option<[f64; 2]>| or_null(range.as_ref()).replace("inf", "Infinity");
            let (control, force) = (range(own.control_range), range(own.force_range));
            let activation = own.activation.as_ref().map_or("null".to_owned(), |own| {
                let (kind, time) = match own.filter {
                    Filter::Integrator => ("integrator", 0.0),
                    Filter::Euler(time) => ("filter", time),
                    Filter::Exact(time) => ("filterexact", time),
                };
                let (range, early) = (range(own.range), own.is_early);
                format!("{{\"kind\": {kind:?}, \"time\": {time:?}, \"range\": {range}, \"early\": {early}}}")
            });
            let frame = |(link, at): &(String, Origin)| format!("[{link:?}, {:?}, {:?}]", at.xyz, turn(at));
            let (mut site, mut path) = ("null".to_owned(), "null".to_owned());
            match &own.frames {
                Some(OnFrames::Site(own)) => {
                    let reference = own.reference.as_ref().map_or("null".to_owned(), frame);
                    site = format!("{{\"at\": {}, \"reference\": {reference}, \"gear\": {:?}}}", frame(&own.at), own.gear);
                }
                Some(OnFrames::Path(strands)) => {
                    path = list(strands, |own| format!("{{\"points\": {}, \"factor\": {:?}}}", list(&own.points, frame), own.factor));
                }
                None => {}
            }
            let terms = own.terms.as_ref().map_or("null".to_owned(), |own| format!("{:?}", [own.rest, own.stiffness, own.damping]));
            format!(
                "{{\"name\": {name:?}, \"terms\": {terms}, \"site\": {site}, \"path\": {path}, \"activation\": {activation}, \"drives\": {drives}, \"gain\": {gain:?}, \"bias\": {bias:?}, \"control_range\": {control}, \"force_range\": {force}}}"
            )
        })
    };
    let keyframe = |own: &Keyframe| {
        let (q, v) = (by_name(&own.q), by_name(&own.v));
        let (name, control, activation) = (&own.name, &own.control, &own.activation);
        format!("{{\"name\": {name:?}, \"q\": {q}, \"v\": {v}, \"control\": {control:?}, \"activation\": {activation:?}}}")
    };
    let couplings = list(&world.couplings, |(own, _)| {
        let leaders = list(&own.leaders, |(name, factor)| format!("[{name:?}, {factor:?}]"));
        format!("{{\"joint\": {:?}, \"leaders\": {leaders}, \"offset\": {:?}, \"higher\": {:?}}}", own.joint, own.offset, own.higher)
    });
    let effects = list(&world.effects, |(own, _)| {
        let (effect, on, xyz, numbers, turn) = (own.effect.name(), &own.on, own.at.xyz, &own.parameters, turn(&own.at));
        format!("{{\"effect\": {effect:?}, \"on\": {on:?}, \"xyz\": {xyz:?}, \"turn\": {turn:?}, \"numbers\": {numbers:?}}}")
    });
    let fields = [
        ("effects", effects),
        ("gravity", or_null(world.gravity.as_ref())),
        ("step", or_null(world.step.as_ref())),
        ("integrator", or_null(world.integrator.as_ref())),
        ("home", world.home.as_ref().map_or("null".to_owned(), keyframe)),
        ("keyframes", list(&world.keyframes, keyframe)),
        ("actuators", actuators(&world.actuators)),
        ("passive", actuators(&world.passive)),
        ("joint_forces", list(&world.joint_forces, |(name, range)| format!("[{name:?}, {range:?}]"))),
        ("couplings", couplings),
        ("planes", list(&world.planes, |own| format!("[{:?}, {:?}, {:?}]", own.name, own.point, own.normal))),
        ("loops", list(&world.loops, |own| format!("{:?}", own.kind))),
    ];
    let fields = fields.map(|(name, value)| format!("\"{name}\": {value}"));
    format!("{{{}}}", fields.join(", "))
}

fn link_of(link: &articulated_core::description::Link) -> String {
    let (mass, center, inertia) = link.inertial.map_or((0.0, [0.0; 3], [0.0; 9]), |inertial| {
        let [xx, xy, xz, yy, yz, zz] = inertial.inertia;
        let rotation = inertial.origin.rotation.matrix::<f64>();
        let own = rotation * articulated_core::spatial::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * rotation.transpose();
        (inertial.mass, inertial.origin.xyz, std::array::from_fn(|k| own[(k / 3, k % 3)]))
    });
    format!("{{\"name\": {:?}, \"mass\": {mass:?}, \"center\": {center:?}, \"inertia\": {inertia:?}}}", link.name)
}

fn joints(description: &Description) -> String {
    let moving = description.joints.iter().filter(|joint| !joint.kind.is_fixed());
    let number = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or("null".to_owned(), |x| format!("{x:?}"));
    let all = moving.map(|joint| {
        let own = joint.dynamics;
        let names = ["damping", "friction", "armature", "stiffness", "rest", "lower", "upper"];
        let limit = joint.limit;
        let values = [own.damping, own.friction, own.armature, own.stiffness, own.rest, limit.map(|l| l.lower), limit.map(|l| l.upper)];
        let fields: Vec<String> = names.iter().zip(values).map(|(name, value)| format!("\"{name}\": {}", number(value))).collect();
        format!("{{\"name\": {:?}, \"kind\": {:?}, {}}}", joint.name, joint.kind.name(), fields.join(", "))
    });
    all.collect::<Vec<_>>().join(", ")
}
