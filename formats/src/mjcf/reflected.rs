//! The mass that an actuator or a spring feels at the reference state.

use articulated_core::algorithm::{Workspace, function};
use articulated_core::description::{Base, Description};
use articulated_core::diagnostic::{Code, Diagnostics, Subject};
use articulated_core::model::Model;

use super::bodies::Kind;
use super::lower::KEPT;
use super::scope::{Known, Scope, freedoms, reference};

/// Joints by their indices, with lengths for a unit of each rate.
pub(crate) type Drives = Vec<(usize, Vec<f64>)>;

/// More degrees of freedom are not factored.
const MOST: usize = 1000;
/// More products are not computed.
const MOST_PRODUCTS: usize = 2_000_000_000;

/// The mass matrix at the reference state, with armature, as L·Lᵀ.
pub(crate) struct Inertia {
    size: usize,
    /// L by rows.
    factor: Vec<f64>,
    /// The first rate of each joint.
    starts: Vec<usize>,
}

impl Inertia {
    /// For so many actuators. `armatures`: each with the lengths that it is on. `None` if the
    /// matrix is not positive definite or very large, or where an armature is on an unknown length.
    pub(crate) fn at_reference(count: usize, description: &Description, scope: &Scope<'_>, armatures: &[(f64, Drives)]) -> Option<Self> {
        if armatures.iter().any(|(armature, drives)| *armature != 0.0 && drives.is_empty()) {
            return None;
        }
        let model: Model<f64> = Model::new(description, Base::Fixed).ok()?;
        let (n, mut q) = (model.nv(), vec![0.0; model.nq()]);
        if n > MOST || n * n * (n + count) > MOST_PRODUCTS {
            return None;
        }
        let mut starts = Vec::with_capacity(scope.joints.len());
        for known in &scope.joints {
            let own = model.joints().iter().find(|joint| joint.name == known.name)?;
            let start = reference(scope, known);
            q.get_mut(own.q.0..own.q.0 + start.len())?.copy_from_slice(&start);
            starts.push(own.v.0);
        }
        let row = function::<f64>("mass_matrix")?;
        let mut matrix = vec![0.0; row.len(model.shape())];
        row.call(&model, &mut Workspace::new(&model), &[&q], &mut matrix).ok()?;
        for (known, start) in scope.joints.iter().zip(&starts) {
            (*start..start + freedoms(known.joint.kind)).for_each(|k| matrix[k * n + k] += known.joint.armature);
        }
        for (armature, drives) in armatures.iter().filter(|(armature, _)| *armature != 0.0) {
            let row = entries(drives, &starts);
            for (i, a) in &row {
                row.iter().for_each(|(j, b)| matrix[i * n + j] += armature * a * b);
            }
        }
        Some(Self { size: n, factor: cholesky(matrix, n)?, starts })
    }

    /// (J M⁻¹ Jᵀ)⁻¹ for the row J of an actuator; `None` where it moves nothing.
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

/// Gives joints the stiffness and the damping of `springdamper`: k = m/(T ζ)² and d = 2 m/T, with
/// the mass m of the joint at the reference state, the time constant T and the ratio ζ.
pub(crate) fn spring_dampers(scope: &Scope<'_>, description: &mut Description, armatures: &[(f64, Drives)], log: &mut Diagnostics) {
    let has_one = |(_, known): &(usize, &Known<'_>)| known.joint.spring_damper.iter().all(|x| *x > 0.0);
    let all: Vec<usize> = scope.joints.iter().enumerate().filter(has_one).map(|(index, _)| index).collect();
    if all.is_empty() {
        return;
    }
    let inertia = if log.is_ok() { Inertia::at_reference(3 * all.len(), description, scope, armatures) } else { None };
    for index in all {
        let Known { joint, name, .. } = scope.joints[index];
        let count = freedoms(joint.kind);
        let along = |k: usize| (0..count).map(|i| f64::from(u8::from(i == k))).collect();
        // 1/m is the mean of the diagonal of M⁻¹
        let mass = inertia.as_ref().filter(|_| joint.kind != Kind::Free).and_then(|inertia| {
            let inverse: Option<f64> = (0..count).map(|k| Some(1.0 / inertia.reflected(&vec![(index, along(k))])?)).sum();
            Some(count as f64 / inverse?)
        });
        let about = Subject::Joint(name.to_owned());
        let (Some(mass), Some(own)) = (mass, description.joint(name)) else {
            let expected = "a hinge, slide or ball of a robot whose mass matrix is regular: else it is not used";
            joint.element.warning((&about, "springdamper"), Code::LostDynamics, "a springdamper", expected, log);
            continue;
        };
        let [time, ratio] = joint.spring_damper;
        let dynamics = &mut description.joints[own].dynamics;
        (dynamics.stiffness, dynamics.damping) = (Some(mass / (time * ratio).powi(2)), Some(2.0 * mass / time));
        if joint.kind != Kind::Ball {
            dynamics.rest = Some(joint.rest);
        }
        for tag in ["joint stiffness", "dynamics damping"] {
            joint.element.unused_part(&about, (joint.element.attribute("springdamper"), tag.to_owned()), KEPT, log);
        }
    }
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
