//! The momentum of a humanoid in free fall, while its joints move as they like.
//!
//! No force but gravity acts from outside, so that the angular momentum k about the centre of mass
//! stays, and the linear momentum l changes by m·g·t, whatever the joints' torques do.
//!
//! ```text
//! cargo run --release -p articulated-examples --bin momentum
//! ```

use articulated::simulate::{IntegratorId, Output, Settings, Simulation};

articulated::robot! {
    /// Thirty joints on a floating pelvis.
    pub mod humanoid {
        urdf = "../models/urdf/humanoid.urdf",
        base = floating,
        functions = [forward_dynamics, integrate, centroidal_momentum],
    }
}

const GRAVITY: f64 = 9.81;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let robot = humanoid::Robot;
    let model = articulated::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf/humanoid.urdf"), articulated::Base::Floating)?;
    let weight = model.moving_mass() * GRAVITY;
    // Arms and legs swing; the trunk rotates at the start.
    let mut wave = |t: f64, _: &[f64], v: &[f64], tau: &mut [f64]| {
        for (k, tau) in tau.iter_mut().enumerate().skip(6) {
            *tau = 4.0 * (5.0 * t + k as f64).sin() - 2.0 * v[k];
        }
    };
    let mut v = [0.0; humanoid::NV];
    v[..3].copy_from_slice(&[0.3, 1.0, -0.2]);
    let settings = Settings {
        end: 1.0,
        integrator: IntegratorId::dop853,
        rtol: 1e-12,
        atol: 1e-13,
        output: Output::Every(0.1),
        ..Settings::default()
    };
    let motion = Simulation::new(&robot, settings)?.run(&humanoid::NEUTRAL, &v, &mut wave, &mut [])?;
    println!("time, s   k, N·m·s                        l_z, N·s   l_z + m g t");
    let start = humanoid::centroidal_momentum(&humanoid::NEUTRAL, &v);
    let mut drift = 0.0_f64;
    for (i, t) in motion.t.iter().enumerate() {
        let h = humanoid::centroidal_momentum(motion.q_at(i).try_into()?, motion.v_at(i).try_into()?);
        let conserved = [h[0], h[1], h[2], h[3], h[4], h[5] + weight * t];
        drift = conserved.iter().zip(&start).fold(drift, |most, (now, then)| most.max((now - then).abs()));
        println!("{t:7.1}   {:9.5} {:9.5} {:9.5}   {:9.3}   {:11.3}", h[0], h[1], h[2], h[5], conserved[5]);
    }
    println!("largest change: {drift:.1e}");
    Ok(())
}
