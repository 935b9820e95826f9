//! An edit: a rigid offset that bends.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::{EditError, Editor, Inertial, Joint, JointId, JointKind, Link, Origin};
use crate::effect::{Applied, EffectId};
use crate::scalar::Scalar;

/// A fixed joint whose rigid offset bends: a straight uniform shaft, the same in both directions,
/// that neither twists nor stretches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shaft {
    /// The fixed joint.
    pub joint: String,
    /// How many pieces bend, at least one.
    pub segments: usize,
    /// Flexural rigidity E·I, N·m², above zero.
    pub stiffness: f64,
    /// Bending moment E·I·damping at the unit rate of curvature, s, not negative.
    pub damping: f64,
    /// Mass, kg, above zero; `None`: that of the link before the joint, which is taken from there.
    pub mass: Option<f64>,
    /// Its start in the frame of the link before the joint, m; `None`: at that frame's origin.
    pub start: Option<[f64; 3]>,
    /// Its end, in the same frame, m; `None`: at the joint's frame. The rest up to the joint is
    /// rigid.
    pub end: Option<[f64; 3]>,
}

impl Shaft {
    /// The name of the k-th joint that bends, from 1 to `segments`.
    pub fn bending(&self, k: usize) -> String {
        format!("{}_{k}", self.joint)
    }

    /// The name of the k-th rod, from 0 to `segments`; the first one's joint is called so too.
    fn rod(&self, k: usize) -> String {
        format!("{}_rod_{k}", self.joint)
    }

    /// Whether a shaft at this joint has a piece of this name, if it has enough of them.
    pub fn may_name(joint: &str, name: &str) -> bool {
        let number = name.strip_prefix(joint).and_then(|rest| rest.strip_prefix('_')).map(|rest| rest.strip_prefix("rod_").unwrap_or(rest));
        number.is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
    }
}

impl Editor<'_> {
    /// Lets the offset of a fixed joint bend. n pieces of length ℓ bend in their middles, in
    /// universal joints called `<joint>_1` … `<joint>_n`, and are otherwise rigid: rods
    /// `<joint>_rod_0` … `<joint>_rod_n` of lengths ½ℓ, ℓ, …, ℓ, ½ℓ, the first fixed to the link
    /// before the joint, the last to that after it. Returns the springs, of stiffness E·I/ℓ, and
    /// the dampings of these joints. Deflections are those of a beam except for a part ¼/n² at a
    /// load on its end. Wittbrodt, Adamiec-Wójcik & Wojciech, Dynamics of Flexible Multibody
    /// Systems: Rigid Finite Element Method, 2006.
    ///
    /// Refused: a joint that does not exist or is not fixed, names that are taken, no pieces, a
    /// shaft without length or mass, numbers that are not finite.
    pub fn shaft(&mut self, shaft: &Shaft) -> Result<Vec<Applied>, EditError> {
        let Some(index) = self.names.joint(&shaft.joint) else {
            return Err(self.unknown_joint(&shaft.joint, |j| j.kind.is_fixed()));
        };
        let Joint { kind, parent: carrier, origin, .. } = self.robot.joints[index];
        if !kind.is_fixed() {
            return Err(EditError::ShaftNotFixed { joint: shaft.joint.clone(), kind });
        }
        let line = Line::of(shaft, origin.xyz, self.robot.links[carrier].inertial)?;
        self.check_free(shaft)?;
        if shaft.mass.is_none() {
            self.robot.links[carrier].inertial = None;
        }
        self.bend(index, shaft, &line);
        Ok(line.springs(shaft))
    }

    fn check_free(&self, shaft: &Shaft) -> Result<(), EditError> {
        let joints = (1..=shaft.segments).map(|k| shaft.bending(k)).filter(|name| self.names.joint(name).is_some());
        let rods = (0..=shaft.segments).map(|k| shaft.rod(k)).filter(|name| self.names.link(name).is_some());
        let root = Some(shaft.rod(0)).filter(|name| self.names.joint(name).is_some());
        let names: Vec<String> = joints.chain(rods).chain(root).collect();
        if names.is_empty() { Ok(()) } else { Err(EditError::NamesTaken { names }) }
    }

    /// Puts the rods and their joints before the joint with this index.
    fn bend(&mut self, index: JointId, shaft: &Shaft, line: &Line) {
        let mut last = line.start;
        let mut parent = self.robot.joints[index].parent;
        for k in 0..=shaft.segments {
            let at = line.joint(k, shaft.segments);
            let next = line.joint(k + 1, shaft.segments);
            let rod = Some(line.rod(minus(next, at)));
            let child = self.add_link(Link { name: shaft.rod(k), inertial: rod, ..Link::default() });
            let (name, kind) = match k {
                0 => (shaft.rod(0), JointKind::Fixed),
                _ => (shaft.bending(k), JointKind::Universal),
            };
            let origin = Origin { xyz: if k == 0 { at } else { minus(at, last) }, ..Origin::default() };
            let [axis, second_axis] = line.axes;
            self.add_joint(Joint { name, kind, parent, child, origin, axis, second_axis, ..Joint::default() });
            (parent, last) = (child, at);
        }
        let joint = &mut self.robot.joints[index];
        joint.parent = parent;
        joint.origin.xyz = minus(joint.origin.xyz, last);
    }
}

/// The shaft where it is straight, in the frame of the link that carries it.
struct Line {
    start: [f64; 3],
    /// From the start to the end, m.
    whole: [f64; 3],
    length: f64,
    mass: f64,
    /// Two unit vectors normal to it and to each other.
    axes: [[f64; 3]; 2],
}

impl Line {
    fn of(shaft: &Shaft, offset: [f64; 3], carrier: Option<Inertial>) -> Result<Self, EditError> {
        let wrong = |field, found, expected| Err(EditError::ShaftNumber { joint: shaft.joint.clone(), field, found, expected });
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let (start, end) = (shaft.start.unwrap_or_default(), shaft.end.unwrap_or(offset));
        let whole = minus(end, start);
        let length = norm(whole);
        let mass = shaft.mass.unwrap_or(carrier.map_or(0.0, |c| c.mass));
        match () {
            () if shaft.segments == 0 => wrong("segments", 0.0, "at least one"),
            () if !positive(shaft.stiffness) => wrong("stiffness", shaft.stiffness, "a finite number of N·m² above 0"),
            () if !(positive(shaft.damping) || shaft.damping == 0.0) => wrong("damping", shaft.damping, "a finite number of s, at least 0"),
            () if !positive(mass) => wrong("mass", mass, "a finite number of kg above 0, or a link with mass before the joint"),
            () if !positive(length) => wrong("length", length, "a start and an end that are apart"),
            () => Ok(Self { start, whole, length, mass, axes: normals(whole.map(|x| x / length)) }),
        }
    }

    /// The place of the k-th of n joints; the start before the first, the end after the last.
    fn joint(&self, k: usize, n: usize) -> [f64; 3] {
        let part = if k > n {
            1.0
        } else if k == 0 {
            0.0
        } else {
            (k as f64 - 0.5) / n as f64
        };
        [0, 1, 2].map(|i| self.start[i] + part * self.whole[i])
    }

    /// A thin rod from its link's origin along `to`: I = m (|r|² 1 − r rᵀ)/12.
    fn rod(&self, to: [f64; 3]) -> Inertial {
        let mass = self.mass * norm(to) / self.length;
        let [x, y, z] = to;
        let moment = mass / 12.0;
        let inertia = [y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y].map(|r| moment * r + 0.0);
        Inertial { origin: Origin { xyz: to.map(|r| r / 2.0), ..Origin::default() }, mass, inertia }
    }

    /// k = E·I/ℓ and d = k·damping on every joint.
    fn springs(&self, shaft: &Shaft) -> Vec<Applied> {
        let stiffness = shaft.stiffness * shaft.segments as f64 / self.length;
        let on = |effect, k: usize, parameters| Applied { effect, on: shaft.bending(k), at: Origin::default(), parameters };
        let spring = |k| on(EffectId::spring, k, Vec::from([stiffness, 0.0]));
        let damping = |k| on(EffectId::damping, k, Vec::from([stiffness * shaft.damping]));
        let damped = (1..=shaft.segments).filter(|_| shaft.damping > 0.0).map(damping);
        (1..=shaft.segments).map(spring).chain(damped).collect()
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn norm(a: [f64; 3]) -> f64 {
    let largest = a.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if largest > 0.0 && largest.is_finite() {
        largest * Scalar::sqrt(a.iter().map(|x| x / largest * (x / largest)).sum::<f64>())
    } else {
        largest
    }
}

/// Two unit vectors normal to the unit vector u and to each other; coordinate axes, if u is one.
fn normals(u: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).min_by(|&i, &j| u[i].abs().total_cmp(&u[j].abs())).unwrap_or(0);
    let mut first = u.map(|x| -u[least] * x);
    first[least] += 1.0;
    let length = norm(first);
    let [a, b, c] = first.map(|x| x / length + 0.0);
    [[a, b, c], [u[1] * c - u[2] * b, u[2] * a - u[0] * c, u[0] * b - u[1] * a].map(|x| x + 0.0)]
}
