//! Logs of a small fleet: a Parquet file for each robot, with the columns robot, q, v, a and tau.

use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

use articulated::{Base, Dynamics, Model, Payload};
use articulated_datafusion::Robot;
use datafusion::arrow::array::{ArrayRef, FixedSizeListArray, Float64Array, RecordBatch, StringArray};
use datafusion::arrow::datatypes::{DataType, Field, Schema};
use datafusion::dataframe::DataFrameWriteOptions;
use datafusion::prelude::SessionContext;

/// The robot that the queries are about. The robots of the fleet differ from it, each in its way.
const URDF: &[u8] = include_bytes!("../../../models/urdf/panda_like.urdf");

/// Residual torques by robot and joint: what was measured less what the model computes.
pub const RESIDUALS: &str = "
    SELECT robot, joint, avg(abs(measured - computed)) AS mean, max(abs(measured - computed)) AS largest
    FROM (SELECT robot, unnest(joint_names()) AS joint, unnest(tau) AS measured, unnest(inverse_dynamics(q, v, a)) AS computed FROM log)
    GROUP BY robot, joint ORDER BY robot, joint";

type Error = Box<dyn std::error::Error + Send + Sync>;

/// The robot as its file describes it.
pub fn robot() -> Result<Robot, Error> {
    Ok(Robot::new(articulated::load_bytes("panda_like.urdf", URDF, Base::Fixed)?))
}

/// A robot of the fleet.
struct Member {
    name: &'static str,
    /// Mass that it carries in its hand, kg.
    payload: f64,
    /// Friction of each joint, N·m.
    friction: [f64; 7],
}

const FLEET: [Member; 3] = [
    Member { name: "arm-1", payload: 0.0, friction: [0.0; 7] },
    Member { name: "arm-2", payload: 0.0, friction: [0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0] },
    Member { name: "arm-3", payload: 1.5, friction: [0.0; 7] },
];

fn list(numbers: Vec<f64>, len: usize) -> Result<ArrayRef, Error> {
    let (field, len) = (Arc::new(Field::new_list_field(DataType::Float64, true)), i32::try_from(len)?);
    Ok(Arc::new(FixedSizeListArray::try_new(field, len, Arc::new(Float64Array::from(numbers)), None)?))
}

/// What a robot logs while its joints swing, a row each 10 ms.
fn log(member: &Member, rows: usize) -> Result<RecordBatch, Error> {
    let mut description = articulated::describe_bytes("panda_like.urdf", URDF)?;
    if member.payload > 0.0 {
        description.attach(&Payload { link: "hand_tcp".into(), mass: member.payload, ..Payload::default() })?;
    }
    let arm = Model::<f64>::new(&description, Base::Fixed)?;
    let (n, mut ws) = (arm.nv(), arm.workspace());
    let [mut q, mut v, mut a, mut tau] = [(); 4].map(|()| vec![0.0; rows * n]);
    for row in 0..rows {
        let range = row * n..(row + 1) * n;
        for k in range.clone() {
            let joint = (k - range.start) as f64;
            let (rate, phase) = (TAU * (0.1 + 0.03 * joint), 0.7 * joint);
            let (sin, cos) = (rate * row as f64 * 0.01 + phase).sin_cos();
            (q[k], v[k], a[k]) = (0.8 * sin, 0.8 * rate * cos, -0.8 * rate * rate * sin);
        }
        arm.inverse_dynamics(&mut ws, &q[range.clone()], &v[range.clone()], &a[range.clone()], &mut tau[range.clone()])?;
        for (k, friction) in range.zip(member.friction) {
            tau[k] += friction * v[k].signum();
        }
    }
    let names: ArrayRef = Arc::new(StringArray::from(vec![member.name; rows]));
    let columns = [("robot", names), ("q", list(q, n)?), ("v", list(v, n)?), ("a", list(a, n)?), ("tau", list(tau, n)?)];
    let fields: Vec<Field> = columns.iter().map(|(name, column)| Field::new(*name, column.data_type().clone(), false)).collect();
    Ok(RecordBatch::try_new(Arc::new(Schema::new(fields)), columns.map(|(_, column)| column).to_vec())?)
}

/// Writes a file for each robot into a folder.
pub async fn write_logs(folder: &Path, rows: usize) -> Result<(), Error> {
    let context = SessionContext::new();
    for member in &FLEET {
        let file = folder.join(member.name).with_extension("parquet");
        let batch = context.read_batch(log(member, rows)?)?;
        batch.write_parquet(&file.to_string_lossy(), DataFrameWriteOptions::new().with_single_file_output(true), None).await?;
    }
    Ok(())
}
