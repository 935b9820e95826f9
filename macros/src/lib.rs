//! The macro `robot!`: a thin shell around `articulated-codegen`.
//!
//! ```text
//! invocation (tokens → tree → settings) → expand (read the files, generate) → place (errors → words)
//! ```

mod errors;
mod expand;
#[cfg(test)]
mod hostile;
mod invocation;
mod settings;
#[cfg(test)]
mod tests;
mod tree;

/// A module with the dynamics of one robot, written out from its URDF when the crate is built.
///
/// ```ignore
/// articulated::robot! {
///     /// Attributes, documentation and visibility are the module's.
///     pub mod panda {
///         urdf = "robots/panda.urdf",                    // from the folder of Cargo.toml; this or `scene` must be there
///         scene = "scenes/panda.toml",                   // a robot with its edits and effects, see docs/scenes.md; the other keys stand in place of its own
///         effects = { damping = { "*" = 0.1 }, friction = urdf }, // what acts beside rigid bodies and gravity, as scenes have it
///         base = fixed,                                  // or floating
///         gravity = [0.0, 0.0, -9.81],                   // m/s², in the world frame
///         functions = [                                  // what to generate: names of `articulated::algorithm`, and
///             placements,
///             inverse_dynamics,
///             hold = inverse_dynamics(v = 0, a = [0, 0]), // one with arguments that are constants,
///             step = forward_dynamics + jacobians_body,  // several in one, which gives a struct with a field for each
///         ],
///         parameters = [payload(tool), inertia(fore), origin(wrist)], // numbers of the model that stay inputs, see below
///         frames = [tool, "left foot"],                  // the links whose frames functions give; absent: all
///         wrenches_in = body,                            // or world, or world_aligned: what the wrenches that functions take refer to
///         lock = { elbow = 0.5, ball = [0.0, 0.0, 0.0, 1.0] }, // joints held where they are: rad or m; a quaternion as x, y, z, w
///         payload = { link = tool, mass = 1.2, center_of_mass = [0.0, 0.0, 0.1] }, // or a list of them; also `inertia` (six numbers), `name`
///         append = { urdf = "gripper.urdf", at = tool, prefix = "left_" }, // another robot; or a list of them; also `xyz`, `rpy`
///         rename = { "a-b" = A_MINUS_B },                // names in Rust for names of the URDF
///         allow_unphysical_inertia = false,              // true: negative principal moments are accepted, with a warning
///         snap_angles = 1e-9,                            // rad, above 0, at most 0.5: angles this near to a multiple of π/2 are taken as that; absent: none
///         limbs = true,                                  // branches that are alike at once, one per lane of a vector, where that is cheaper
///         batch = [],                                    // [f64, f32]: functions of many states at once too, in modules batch_f64, batch_f32
///         level = f64,                                   // how accurate: also f32, f32_f64, compensated + two, double_double, f64 + fast_10 + no_fma, …
///         forbid_unsafe = false,                         // true: no `unsafe` in the module; slower on x86-64: no limbs in lanes, no choice of instructions
///         max_code_size = 64,                            // MB of code that all functions together may become; more is an error
///         no_std = false,                                // true: for crates without `std`, which depend on the crate `libm`; without `unsafe`, multiply-adds and `Dynamics`
///         crate = ::articulated,                         // the path of this crate, if it has another name
///         standalone = false,                            // true: no implementation of `Dynamics`, no dependence on this crate
///     }
/// }
/// ```
///
/// The values above are the defaults, but for `urdf`, `scene`, `effects`, `rename`, `snap_angles`, the last two functions, and those from `parameters` to `append`. Names of links and joints
/// are words or stand in quotation marks. Robots are appended first, then payloads attached, then joints locked. The module has one function for each name in `functions`
/// (for each of a group that is named there; beside a scene, `motion` stands for all that its motion calls),
/// constants for sizes, names, limits and the neutral configuration, modules of indices (`joint`, `q_index`, `v_index`, `frame`), and `Robot`, a value that
/// implements `articulated::Dynamics`. What looks wrong in the URDF is listed in its constant `WARNINGS`, and the compiler warns of it (as of a deprecated constant, for a macro
/// has no other way; `#[allow(deprecated)]` on the module silences it). It is compiled
/// again when a URDF or the scene changes. With `parameters` every function takes their numbers as the last of its inputs, before `out` where it has that; the constant `PARAMETERS` has those of the URDF, the
/// module `parameter` where each begins, and `Robot` holds its own; functions of many states take a set for each state, or one for all. `payload(link)` and `inertia(link)` are ten: m, m·c and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz
/// about the origin of the link's frame in its axes, added to what the link has or in its place; `origin(joint)` is the joint's xyz in its parent link, m; `gravity` the three of gravity, m/s²; `damping(joint)`, `contact(link)` and so on the numbers of an effect that is on there. A build script (`articulated_codegen::Build`) gives the same code, to read and to step through.
///
/// Errors: all that is wrong with the invocation and with the URDF at once, each at the word that it is about.
#[proc_macro]
pub fn robot(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand::expand(input.into()).into()
}
