//! Serial arms of any length.

use std::fmt::Write;

/// The axes of the joints, one after the other.
const AXES: [&str; 4] = ["0 0 1", "0 1 0", "1 0 0", "0 -1 0"];

/// Every joint with a multiple of this number is oblique, as at a wrist.
const ASKEW: usize = 5;

/// The URDF of a serial arm of `joints` revolute joints: axes that change from joint to joint,
/// every fifth joint oblique by angles that are not multiples of π/2, and links with a centre of
/// mass off every axis and a full inertia. The same number always gives the same arm; a shorter one
/// is the beginning of a longer one.
pub fn chain(joints: usize) -> String {
    let mut out = format!("<robot name=\"chain_{joints}\">\n");
    out += "  <link name=\"link_0\"/>\n";
    for k in 1..=joints {
        joint(&mut out, k);
        link(&mut out, k);
    }
    out + "</robot>\n"
}

fn link(out: &mut String, k: usize) {
    let mass = 0.5 + vary(k, 1);
    let [x, y, z] = [2, 3, 4].map(|n| 0.1 * vary(k, n) - 0.05);
    // Second moments about the centre of mass, and from them a physical inertia.
    let [a, b, c] = [5, 6, 7].map(|n| mass * (1e-3 + 2e-3 * vary(k, n)));
    let [xy, xz, yz] = [8, 9, 10].map(|n| mass * (4e-4 * vary(k, n) - 2e-4));
    let (xx, yy, zz) = (b + c, a + c, a + b);
    let _ = writeln!(
        out,
        "  <link name=\"link_{k}\"><inertial><origin xyz=\"{x:.4} {y:.4} {z:.4}\"/><mass value=\"{mass:.4}\"/>\
         <inertia ixx=\"{xx:.6}\" ixy=\"{xy:.6}\" ixz=\"{xz:.6}\" iyy=\"{yy:.6}\" iyz=\"{yz:.6}\" izz=\"{zz:.6}\"/></inertial></link>"
    );
}

fn joint(out: &mut String, k: usize) {
    let (parent, axis) = (k - 1, AXES[k % AXES.len()]);
    let length = 0.1 + 0.2 * vary(k, 11);
    // Along x and z in turn; every third joint is off the line of the link.
    let offset = if k.is_multiple_of(3) { 0.05 * vary(k, 12) } else { 0.0 };
    let (x, z) = if k.is_multiple_of(2) { (length, 0.0) } else { (0.0, length) };
    let [roll, pitch, yaw] = if k.is_multiple_of(ASKEW) { [13, 14, 15].map(|n| vary(k, n) - 0.5) } else { [0.0; 3] };
    let _ = writeln!(
        out,
        "  <joint name=\"joint_{k}\" type=\"revolute\"><parent link=\"link_{parent}\"/><child link=\"link_{k}\"/>\
         <origin xyz=\"{x:.4} {offset:.4} {z:.4}\" rpy=\"{roll:.4} {pitch:.4} {yaw:.4}\"/><axis xyz=\"{axis}\"/>\
         <limit lower=\"-3\" upper=\"3\" effort=\"100\" velocity=\"3\"/></joint>"
    );
}

/// A fixed irregular number in 0…1 for each property of each link.
fn vary(k: usize, property: usize) -> f64 {
    ((k * 16 + property) as f64 * 0.618_033_988_749_894_8).fract()
}

#[cfg(test)]
mod tests {
    use articulated_codegen::{Generated, Request, generate};

    use super::chain;

    fn generated(function: &str, joints: usize) -> Generated {
        let mut request = Request::new("chain.urdf", chain(joints));
        request.options.functions = vec![function.into()];
        generate(&request).unwrap()
    }

    /// Operations requested while tracing, instructions emitted, and bytes of source, for each
    /// joint added between 80 and 120, and between 120 and 200: long enough that all of it is
    /// written in pieces.
    fn per_joint(function: &str) -> [[f64; 2]; 3] {
        let work = [80, 120, 200].map(|n| {
            let generated = generated(function, n);
            let entry = &generated.ledger.functions[0];
            [entry.stages[0].1.operations(), entry.emitted().instructions(), generated.source.len() as u64].map(|x| x as f64)
        });
        [0, 1, 2].map(|k| [(work[1][k] - work[0][k]) / 40.0, (work[2][k] - work[1][k]) / 80.0])
    }

    #[test]
    fn what_is_done_for_a_joint_does_not_depend_on_how_many_there_are() {
        for function in ["inverse_dynamics", "forward_dynamics"] {
            for [near, far] in per_joint(function) {
                assert!((far / near - 1.0).abs() < 0.06, "{function}: {near} then {far} for a joint");
            }
        }
    }

    #[test]
    fn a_matrix_grows_with_the_square_of_the_chain_and_no_faster() {
        let work = [20, 40, 80].map(|n| generated("mass_matrix", n).ledger.functions[0].emitted().instructions() as f64);
        // For a n² + b n + c with positive a, the ratio of second differences is exactly 4 for
        // these lengths, independent of b and c.
        let second = [work[1] - 2.0 * work[0], work[2] - 2.0 * work[1]];
        assert!((second[1] / second[0] - 4.0).abs() < 0.2, "{work:?}");
    }

    #[test]
    fn a_chain_is_a_robot_without_oddities() {
        for n in [1, 7, 100] {
            let reading = Request::new("chain.urdf", chain(n)).build_robot().unwrap().reading;
            assert_eq!((reading.description.joints.len(), reading.warnings.len(), reading.unused.len()), (n, 0, 0), "{:?}", reading.unused);
        }
    }
}
