//! A robot under a controller at 1 kHz. Run it with `cargo run --release`.

use std::fmt::Write;

use articulated::Dynamics;
use articulated::simulate::{Output, Settings, Simulation};

articulated::robot! {
    /// `quadruped`: 19 coordinates, 18 degrees of freedom.
    pub mod robot {
        urdf = "../models/urdf/quadruped.urdf",
        base = floating,
        functions = [forward_dynamics, integrate, difference],
    }
}

/// The controller's period and the end of the motion, s.
const PERIOD: f64 = 1e-3;
const END: f64 = 3.0;
/// The degrees of freedom that torques drive: not those of a floating base.
const DRIVEN: std::ops::Range<usize> = 6..robot::NV;

/// Springs and dampers in the joints. Choose the gains for your robot.
fn controller(target: &[f64; robot::NQ], q: &[f64; robot::NQ], v: &[f64; robot::NV]) -> [f64; robot::NV] {
    let error = robot::difference(q, target); // target ⊖ q
    std::array::from_fn(|k| if DRIVEN.contains(&k) { 100.0 * error[k] - 10.0 * v[k] } else { 0.0 })
}

/// Where the joints shall go: half a radian (or metre) from where they start, within their limits.
fn target(start: &[f64; robot::NQ]) -> [f64; robot::NQ] {
    let step = std::array::from_fn(|k| if DRIVEN.contains(&k) { 0.5 } else { 0.0 });
    let mut target = robot::integrate(start, &step); // start ⊕ step
    for (k, q) in target.iter_mut().enumerate() {
        if robot::Q_LOWER[k] < robot::Q_UPPER[k] {
            *q = q.clamp(robot::Q_LOWER[k], robot::Q_UPPER[k]);
        }
    }
    target
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut q, mut v) = (robot::NEUTRAL, [0.0; robot::NV]);
    let target = target(&q);
    let mut errors = vec![(0.0, robot::difference(&q, &target))];
    let settings = Settings { end: END, output: Output::Steps, ..Settings::default() };
    let mut simulation = Simulation::new(&robot::Robot, settings)?;
    for step in 0..(END / PERIOD) as u32 {
        let t = f64::from(step) * PERIOD;
        let tau = controller(&target, &q, &v);
        // The robot moves for one period under these torques.
        simulation.set_span(t, t + PERIOD)?;
        let mut hold = |_: f64, _: &[f64], _: &[f64], out: &mut [f64]| out.copy_from_slice(&tau);
        let motion = simulation.run(&q, &v, &mut hold, &mut [])?;
        let last = motion.len() - 1;
        (q, v) = (motion.q_at(last).try_into()?, motion.v_at(last).try_into()?);
        if step % 20 == 19 {
            errors.push((t + PERIOD, robot::difference(&q, &target)));
        }
    }
    let largest = errors.last().map_or(0.0, |(_, e)| e[DRIVEN].iter().fold(0.0, |most: f64, e| most.max(e.abs())));
    println!("largest distance from the target after {END} s: {largest:.2e} rad or m");
    std::fs::write("motion.svg", plot(&errors))?;
    println!("motion.svg shows the distance of each joint from its target over time");
    Ok(())
}

/// The name of the joint that degree of freedom `k` belongs to.
fn joint(k: usize) -> String {
    let mut joints = (0..robot::JOINTS).filter_map(|index| robot::Robot.joint(index));
    joints.rfind(|joint| joint.v.0 <= k).map_or(String::new(), |joint| joint.name.replace(['<', '&'], "_"))
}

/// One line for each degree of freedom that is driven: its distance from the target over time.
fn plot(errors: &[(f64, [f64; robot::NV])]) -> String {
    let (width, height) = (640.0, 360.0);
    let largest = errors.iter().flat_map(|(_, e)| &e[DRIVEN]).fold(1e-9, |most: f64, e| most.max(e.abs()));
    let mut svg =
        String::from("<svg xmlns='http://www.w3.org/2000/svg' viewBox='-60 -20 920 430' font-family='sans-serif' font-size='12'>");
    let _ = write!(svg, "<rect x='-60' y='-20' width='920' height='430' fill='white'/>");
    for (value, label) in [(largest, format!("{largest:.2}")), (0.0, "0".into()), (-largest, format!("{:.2}", -largest))] {
        let y = height / 2.0 * (1.0 - value / largest);
        let _ = write!(svg, "<path d='M0 {y}H{width}' stroke='#ccc'/><text x='-6' y='{y}' text-anchor='end'>{label}</text>");
    }
    let below = (height / DRIVEN.len() as f64).min(16.0); // from one name of the legend to the next
    for k in DRIVEN {
        let (hue, y) = (360 * k / robot::NV, 12.0 + below * (k - DRIVEN.start) as f64);
        let _ = write!(svg, "<text x='660' y='{y:.1}' font-size='{:.1}' fill='hsl({hue} 70% 35%)'>{}</text>", 0.8 * below, joint(k));
        let points: Vec<String> =
            errors.iter().map(|(t, e)| format!("{:.1},{:.1}", width * t / END, height / 2.0 * (1.0 - e[k] / largest))).collect();
        let _ = write!(svg, "<polyline points='{}' fill='none' stroke='hsl({hue} 70% 45%)'/>", points.join(" "));
    }
    let _ = write!(svg, "<text x='0' y='385'>0 s</text><text x='{width}' y='385' text-anchor='end'>{END} s</text>");
    let _ = write!(svg, "<text x='{}' y='385' text-anchor='middle'>new_walker: target − q, rad or m</text></svg>", width / 2.0);
    svg
}
