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

/// A module with the dynamics of one robot, generated from its file (URDF, xacro, MJCF or SDF) when
/// the crate is built.
///
/// ```ignore
/// articulated::robot! {
///     /// Attributes, documentation and visibility are the module's.
///     pub mod panda {
///         urdf = "robots/panda.urdf", // from the folder of Cargo.toml
///         functions = [inverse_dynamics, forward_dynamics],
///     }
/// }
/// ```
///
/// The module contains
///
/// * one function for each name in `functions`, and a form `…_into` that writes into your array;
/// * constants: sizes (`NQ`, `NV`, …), names, limits, and `NEUTRAL`, the neutral configuration;
/// * modules of indices: `joint`, `q_index`, `v_index`, `frame`;
/// * `Robot`, a value that implements `articulated::Dynamics`;
/// * `WARNINGS` about the file. The compiler shows them too, as uses of a deprecated constant,
///   because a macro has no other way. `#[allow(deprecated)]` on the module silences them.
///
/// # Keys
///
/// `urdf` or `scene` is required. The example has the default of each key, except where a comment
/// says "default: none".
///
/// ```ignore
/// articulated::robot! {
///     pub mod panda {
///         urdf = "robots/panda.urdf",
///         scene = "scenes/panda.toml", // default: none. A robot with its edits and effects; other keys replace those of the scene
///         effects = { damping = { "*" = 0.1 }, friction = urdf }, // default: none. As in a scene
///         base = fixed, // or floating
///         gravity = [0.0, 0.0, -9.81], // m/s², in the world frame
///         functions = [ // names or groups of functions of `articulated::algorithm`
///             placements,
///             inverse_dynamics,
///             hold = inverse_dynamics(v = 0, a = [0, 0]), // default: none. Fixed arguments
///             step = forward_dynamics + jacobians_body, // default: none. Several in one: a struct with a field for each
///         ],
///         parameters = [payload(tool), inertia(fore), origin(wrist)], // default: none. Constants that become inputs
///         frames = [tool, "left foot"], // default: all. The links whose frames are computed
///         wrenches_in = body, // the reference of wrench arguments; or world, world_aligned
///         // default: none. A joint that follows others
///         coupling = { pitch = { joint = [m1, m2], coefficients = [0.5, -0.5], offset = 0.0 } },
///         lock = { elbow = 0.5, ball = [0.0, 0.0, 0.0, 1.0] }, // default: none. rad or m; a quaternion as x, y, z, w
///         payload = { link = tool, mass = 1.2, center_of_mass = [0.0, 0.0, 0.1] }, // default: none. One or a list; also `inertia` (six numbers), `name`
///         append = { urdf = "gripper.urdf", at = tool, prefix = "left_" }, // default: none. Another robot, or a list; also `xyz`, `rpy`
///         // default: those of the file. Arguments of a xacro file
///         args = { hand = true, prefix = "left_" },
///         // default: those around the file. Folders for `$(find parts)`
///         packages = { parts = "../parts" },
///         rename = { "a-b" = A_MINUS_B }, // default: none. Names in Rust for names of the file
///         allow_unphysical_inertia = false, // true: negative principal moments are a warning
///         first_of_duplicates = false, // true: the first of contradicting tags counts
///         leave_out = [], // [flex, composite, plugin, …]: what is left out of an MJCF
///         given_contacts = [], // [["floor", "foot", 4], …]: geoms whose contacts you find (MJCF)
///         allow_unknown_version = false, // true: a URDF of an unknown version is read as 1.0
///         snap_angles = 1e-9, // default: none. rad, above 0, at most 0.5: angles this near to a multiple of π/2 become that multiple
///         limbs = true, // isomorphic limbs together, one per lane of a vector, where that is cheaper
///         batch = [], // [f64, f32]: functions of many states, in modules batch_f64, batch_f32
///         level = f64, // accuracy; also f32, f32_f64, compensated + two, double_double, f64 + fast_10 + no_fma, …
///         forbid_unsafe = false, // true: no `unsafe`; slower on x86-64: no limbs in lanes, no choice of instructions
///         max_code_size = 64, // MB of code of all functions together; more is an error
///         no_std = false, // true: for crates without `std`, which depend on the crate `libm`; no `unsafe`, no multiply-adds, no `Dynamics`
///         crate = ::articulated, // the path of this crate, if it has another name
///         standalone = false, // true: no implementation of `Dynamics`, no dependence on this crate
///     }
/// }
/// ```
///
/// Names of links and joints are words, or they are in quotation marks. Edits happen in this order:
/// append robots, attach payloads, lock joints. Beside a scene, `motion` in `functions` means all
/// functions that the motion of the scene calls. The macro runs again when a robot file or the
/// scene changes. A build script (`articulated_codegen::Build`) generates the same code, to read and to
/// step through.
///
/// # Parameters
///
/// With `parameters` every function takes their numbers as its last input, before `out` if it has
/// that. The constant `PARAMETERS` has the values of the file, and the module `parameter` has the
/// index of each. `Robot` holds its own values. Functions of many states take one set for each
/// state, or one for all.
///
/// | entry | numbers |
/// |---|---|
/// | `payload(link)` | 10: m, m·c and I_xx, I_xy, I_xz, I_yy, I_yz, I_zz about the origin of the link's frame in its axes; added to the link |
/// | `inertia(link)` | the same 10, in place of the link's own |
/// | `origin(joint)` | 3: the joint's xyz in its parent link, m |
/// | `gravity` | 3, m/s² |
/// | `damping(joint)`, `contact(link)`, … | the numbers of an effect that is on there |
///
/// # Errors
///
/// All mistakes of the invocation and of the file at once, each at its word.
#[proc_macro]
pub fn robot(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand::expand(input.into()).into()
}
