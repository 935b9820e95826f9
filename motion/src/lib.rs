//! A scene's motion in a program: its start, its control, its events, moved by any robot.
//!
//! A [`Session`] is a scene with its robot. [`Session::open`] reads it, [`Session::run`] moves it,
//! and [`Session::run_with`] moves it with another control. The robot is anything that has
//! dynamics: the generic model, or a generated robot.
//!
//! ```
//! use articulated_motion::{Ending, Session};
//!
//! const URDF: &str = r#"<robot name="pendulum"><link name="base"/>
//!   <link name="bob"><inertial><origin xyz="0 0 -1"/><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
//!   <joint name="hinge" type="revolute"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/>
//!     <limit lower="-1.5" upper="0.5" effort="9" velocity="9"/></joint></robot>"#;
//! const SCENE: &str = r#"
//!   urdf = "pendulum.urdf"
//!   initial = { q = { hinge = -1.0 } }
//!   effects = { damping = { hinge = 0.1 } }
//!   control = { kind = "pd", target = { hinge = 1.0 }, kp = 20.0, kd = 2.0 }
//!   simulation = { end = 12.0, events = ["limits"] }
//! "#;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = std::env::temp_dir().join(format!("articulated-swing-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! # let path = folder.join("swing.toml");
//! # std::fs::write(folder.join("pendulum.urdf"), URDF)?;
//! # std::fs::write(&path, SCENE)?;
//! let session = Session::open(&path)?;
//! # std::fs::remove_dir_all(&folder)?;
//! session.warnings.iter().for_each(|warning| eprintln!("{warning}"));
//! let swing = session.run(&session.model, &session.frame_names())?;
//!
//! assert_eq!((swing.ending, swing.reached, swing.error), (Ending::AtEnd, 12.0, None));
//! assert_eq!(swing.occurrences[0].what, "hinge reaches its upper limit");
//! let last = swing.recording.len() - 1;
//! // It rests where kp (target − q) = m g l sin q.
//! let q = swing.recording.q_at(last)[0];
//! assert!((20.0 * (1.0 - q) - 9.81 * q.sin()).abs() < 1e-3);
//!
//! // A control of one's own in place of the scene's; in an articulated::simulate::Hold it is asked at a rate.
//! let mut push = |t: f64, _q: &[f64], v: &[f64], tau: &mut [f64]| tau[0] = 2.0 * t.sin() - 0.5 * v[0];
//! let pushed = session.run_with(&session.model, &session.frame_names(), &mut push)?;
//! assert_eq!((pushed.ending, pushed.error), (Ending::AtEnd, None));
//! # Ok(()) }
//! ```
//!
//! Step by step: [`Session::initial_state`] is the initial state and control, [`Session::settings`]
//! are the simulation settings, [`Session::motion`] combines them with a robot, and [`Motion::run`]
//! runs the motion, any number of times. A robot generated for a scene needs the functions of
//! [`Session::functions`] and the frames of [`Session::frames`]. The parts also serve a user's own
//! simulation: [`Drive`] is the scene's control, and [`Detectors`] has its events and their
//! descriptions. All errors that keep a scene from moving are reported at once, as
//! [`MotionErrors`].
//!
//! To run many motions in parallel, share the [`Session`], the robot and the [`InitialState`]
//! between threads, and let each thread create one [`Motion`] of its own.
//!
//! ```
//! # use articulated_motion::{InitialState, MotionErrors, Session};
//! /// Where the first joint ends from each of these starts, rad.
//! fn ends(session: &Session, starts: &[InitialState], threads: usize) -> Result<Vec<f64>, MotionErrors> {
//!     let some = |starts: &[InitialState]| -> Result<Vec<f64>, MotionErrors> {
//!         let mut motion = session.motion(&session.model, &session.frame_names(), session.settings()?)?;
//!         let end = |initial| motion.run(initial, &mut |_, _| true).map(|o| o.recording.q_at(o.recording.len() - 1)[0]);
//!         starts.iter().map(end).collect()
//!     };
//!     let share = starts.len().div_ceil(threads).max(1);
//!     std::thread::scope(|scope| {
//!         let running: Vec<_> = starts.chunks(share).map(|part| scope.spawn(move || some(part))).collect();
//!         running.into_iter().try_fold(Vec::new(), |all, thread| Ok([all, thread.join().expect("no motion panics")?].concat()))
//!     })
//! }
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = std::env::temp_dir().join(format!("articulated-threads-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! # let urdf = r#"<robot name="p"><link name="base"/><link name="bob"><inertial><origin xyz="0 0 -1"/><mass value="1"/>
//! #   <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
//! #   <joint name="hinge" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint></robot>"#;
//! # std::fs::write(folder.join("p.urdf"), urdf)?;
//! # std::fs::write(folder.join("s.toml"), "urdf = 'p.urdf'\nsimulation = { end = 0.5 }")?;
//! # let session = Session::open(folder.join("s.toml"))?;
//! # std::fs::remove_dir_all(&folder)?;
//! # let initial = session.initial_state()?;
//! # let starts: Vec<InitialState> = (0..7).map(|k| InitialState { q: vec![0.1 * f64::from(k)], ..initial.clone() }).collect();
//! # assert_eq!(ends(&session, &starts, 2)?, ends(&session, &starts, 1)?);
//! # assert_eq!(ends(&session, &starts, 9)?.len(), 7);
//! # Ok(()) }
//! ```
//!
//! Conventions are those of [`articulated`]: SI units and radians; q and v in the order of the
//! robot.

mod compatibility;
mod creep;
mod detectors;
mod error;
mod freedom;
mod initial_state;
mod motion;
mod occurrence;
mod penetration;
mod projectile;
mod requirements;
mod rolling;
mod session;
mod settings;
mod slide;
mod statistics;
mod touch;

pub use articulated::simulate::{Controller, Counts, Drive, Recording, Settings, SimulateError};
pub use articulated_scene::Scene;
pub use creep::Creep;
pub use detectors::{Detectors, UnavailableEvent};
pub use error::{Fault, MotionError, MotionErrors};
pub use initial_state::{Beyond, InitialState, Sunk};
pub use motion::{Ending, Motion, Outcome};
pub use occurrence::{EventKind, Occurrence, SceneEvent};
pub use penetration::Penetration;
pub use rolling::Rolling;
pub use session::{Session, field};
pub use slide::Slide;
