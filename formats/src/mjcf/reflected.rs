//! The mass that an actuator or a spring feels at the reference state.

use std::collections::BTreeMap;

use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{Base, Description};
use articulated_core::diagnostic::{Code, Diagnostics, Subject};
use articulated_core::model::Model;

use super::bodies::Kind;
use super::lower::KEPT;
use super::scope::{Known, Scope, freedoms, reference};
use super::simulation::Flags;

/// Joints by their indices, with lengths for a unit of each rate.
pub(crate) type Drives = Vec<(usize, Vec<f64>)>;

/// Inertia of an actuator or a tendon.
pub(crate) struct Rotor {
    pub(crate) armature: f64,
    /// The length for a unit of each rate in the reference pose, if it is known.
    pub(crate) row: Option<Drives>,
    /// Whether it is one of an actuator of joints, whose row is constant.
    pub(crate) of_joints: bool,
}

/// More degrees of freedom are not factored.
const MOST: usize = 1000;
/// More products are not computed.
const MOST_PRODUCTS: usize = 2_000_000_000;

/// Why no mass is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unknown {
    /// The file has mistakes.
    Mistakes,
    /// An armature is on a length that is not read.
    Armature,
    /// The robot has very many degrees of freedom.
    Size,
    /// The mass matrix is singular.
    Singular,
}

impl Unknown {
    /// The message about an element that needs the mass.
    pub(crate) fn found(self, what: &str) -> String {
        match self {
            Self::Armature => format!("{what} beside a tendon around a geom with armature"),
            Self::Size => format!("{what} in a robot of very many degrees of freedom"),
            Self::Mistakes | Self::Singular => format!("{what} in a robot whose mass matrix is singular"),
        }
    }
}

/// The mass matrix at the reference state, with armature, as L·Lᵀ.
pub(crate) struct Inertia {
    size: usize,
    /// L by rows.
    factor: Vec<f64>,
    /// The first rate of each joint.
    starts: Vec<usize>,
}

impl Inertia {
    /// For `count` actuators.
    pub(crate) fn at_reference(
        count: usize,
        description: &Description,
        scope: &Scope<'_>,
        rotors: &[Rotor],
        log: &Diagnostics,
    ) -> Result<Self, Unknown> {
        if !log.is_ok() {
            return Err(Unknown::Mistakes);
        }
        if rotors.iter().any(|rotor| rotor.armature != 0.0 && rotor.row.is_none()) {
            return Err(Unknown::Armature);
        }
        let model: Model<f64> = Model::new(description, Base::Fixed).map_err(|_| Unknown::Mistakes)?;
        let n = model.nv();
        if n > MOST || n * n * (n + count) > MOST_PRODUCTS {
            return Err(Unknown::Size);
        }
        Self::of(&model, scope, rotors).ok_or(Unknown::Singular)
    }

    fn of(model: &Model<f64>, scope: &Scope<'_>, rotors: &[Rotor]) -> Option<Self> {
        let (n, mut q) = (model.nv(), vec![0.0; model.nq()]);
        let mut starts = Vec::with_capacity(scope.joints.len());
        for known in &scope.joints {
            let own = model.joints().iter().find(|joint| joint.name == known.name)?;
            let start = reference(scope, known);
            q.get_mut(own.q.0..own.q.0 + start.len())?.copy_from_slice(&start);
            starts.push(own.v.0);
        }
        let row = function::<f64>("mass_matrix")?;
        let mut matrix = vec![0.0; row.len(model.shape())];
        row.call(model, &mut Workspace::new(model), &[&q], &mut matrix).ok()?;
        for (known, start) in scope.joints.iter().zip(&starts) {
            (*start..start + freedoms(known.joint.kind)).for_each(|k| matrix[k * n + k] += known.joint.armature);
        }
        let heavy = rotors.iter().filter(|rotor| rotor.armature != 0.0);
        for (armature, drives) in heavy.filter_map(|rotor| Some((rotor.armature, rotor.row.as_ref()?))) {
            for (one, own) in drives {
                // MuJoCo's matrix has no entries for joints of different branches.
                for (other, others) in drives.iter().filter(|(other, _)| is_one_branch(scope, *one, *other)) {
                    let entry = |k: usize, l: usize| (starts[*one] + k) * n + starts[*other] + l;
                    for (k, a) in own.iter().enumerate() {
                        others.iter().enumerate().for_each(|(l, b)| matrix[entry(k, l)] += armature * a * b);
                    }
                }
            }
        }
        Some(Self { size: n, factor: cholesky(matrix, n)?, starts })
    }

    /// (J M⁻¹ Jᵀ)⁻¹ for the row J of an actuator; `None` if it moves no joint.
    pub(crate) fn reflected(&self, drives: &Drives) -> Option<f64> {
        let mut x = vec![0.0; self.size];
        entries(drives, &self.starts).iter().for_each(|(k, gear)| x[*k] += gear);
        // L y = Jᵀ
        for i in 0..self.size {
            let row = &self.factor[i * self.size..][..=i];
            let sum: f64 = row[..i].iter().zip(&x).map(|(l, y)| l * y).sum();
            x[i] = (x[i] - sum) / row[i];
        }
        let inverse: f64 = x.iter().map(|y| y * y).sum();
        (inverse > 0.0 && inverse.is_finite()).then(|| 1.0 / inverse)
    }
}

/// Whether one of two joints carries the other.
fn is_one_branch(scope: &Scope<'_>, one: usize, other: usize) -> bool {
    let [one, other] = [one, other].map(|joint| scope.joints[joint].body);
    let (upper, mut body) = (one.min(other), one.max(other));
    // Parents come first.
    while body > upper {
        body = scope.tree.bodies[body].parent;
    }
    body == upper
}

/// Sets the stiffness and the damping of joints with `springdamper`: k = m/(T ζ)² and d = 2 m/T,
/// with the mass m of the joint at the reference state, the time constant T and the ratio ζ.
/// Returns the stiffnesses of free joints, by their indices.
pub(crate) fn spring_dampers(
    scope: &Scope<'_>,
    flags: Flags,
    description: &mut Description,
    rotors: &[Rotor],
    log: &mut Diagnostics,
) -> BTreeMap<usize, f64> {
    let mut free = BTreeMap::new();
    let has_one = |(_, known): &(usize, &Known<'_>)| known.joint.spring_damper.iter().all(|x| *x > 0.0);
    let all: Vec<usize> = scope.joints.iter().enumerate().filter(has_one).map(|(index, _)| index).collect();
    if all.is_empty() || flags.no_passive_force() {
        return free;
    }
    let inertia = Inertia::at_reference(6 * all.len(), description, scope, rotors, log);
    for index in all {
        let Known { joint, name, .. } = scope.joints[index];
        let count = freedoms(joint.kind);
        let along = |k: usize| (0..count).map(|i| f64::from(u8::from(i == k))).collect();
        // 1/m is the mean of the diagonal of M⁻¹
        let mass = inertia.as_ref().map_err(|why| *why).and_then(|inertia| {
            let inverse: Option<f64> = (0..count).map(|k| Some(1.0 / inertia.reflected(&vec![(index, along(k))])?)).sum();
            Ok(count as f64 / inverse.ok_or(Unknown::Singular)?)
        });
        let about = Subject::Joint(name.to_owned());
        let found = match mass {
            Ok(mass) => Ok(mass),
            // These errors are already reported.
            Err(Unknown::Mistakes) => continue,
            Err(why) => Err(why.found("a springdamper")),
        };
        let (mass, own) = match (found, description.joint(name)) {
            (Ok(mass), Some(own)) => (mass, own),
            (Ok(_), None) => continue,
            (Err(found), _) => {
                let expected = "a joint that moves a known mass: else it is not used";
                joint.element.warning((&about, "springdamper"), Code::LostDynamics, found, expected, log);
                continue;
            }
        };
        let [time, ratio] = joint.spring_damper;
        let dynamics = &mut description.joints[own].dynamics;
        if !flags.no_damper {
            dynamics.damping = Some(2.0 * mass / time);
        }
        let stiffness = mass / (time * ratio).powi(2);
        let is_free = joint.kind == Kind::Free;
        if is_free && !flags.no_spring {
            free.insert(index, stiffness);
        } else if !flags.no_spring {
            dynamics.stiffness = Some(stiffness);
            if joint.kind != Kind::Ball {
                dynamics.rest = Some(joint.rest);
            }
        }
        let tags = [("joint stiffness", flags.no_spring || is_free), ("dynamics damping", flags.no_damper)];
        for (tag, _) in tags.into_iter().filter(|(_, is_off)| !is_off) {
            joint.element.unused_part(&about, (joint.element.attribute("springdamper"), tag.to_owned()), KEPT, log);
        }
    }
    free
}

fn entries(drives: &Drives, starts: &[usize]) -> Vec<(usize, f64)> {
    drives.iter().flat_map(|(joint, gears)| gears.iter().enumerate().map(|(k, gear)| (starts[*joint] + k, *gear))).collect()
}

/// L of L·Lᵀ, by rows. Golub & Van Loan, *Matrix Computations*, §4.2.
fn cholesky(mut a: Vec<f64>, n: usize) -> Option<Vec<f64>> {
    for i in 0..n {
        let (done, rest) = a.split_at_mut(i * n);
        let row = &mut rest[..n];
        for j in 0..i {
            let other = &done[j * n..][..=j];
            let sum: f64 = row[..j].iter().zip(other).map(|(x, y)| x * y).sum();
            row[j] = (row[j] - sum) / other[j];
        }
        let pivot = row[i] - row[..i].iter().map(|x| x * x).sum::<f64>();
        row[i] = Some(pivot.sqrt()).filter(|root| *root > 0.0 && root.is_finite())?;
    }
    Some(a)
}
