//! Rows per second of inverse dynamics of a seven-axis arm: the functions alone, and by SQL.
//!
//! ```text
//! cargo run --release --example rows_per_second
//! ```

use std::time::Instant;

use articulated::{Base, Dynamics};
use articulated_datafusion::Robot;
use datafusion::arrow::array::{ArrayRef, FixedSizeListArray, Float64Array, RecordBatch};
use datafusion::arrow::datatypes::{DataType, Field, Schema};
use datafusion::dataframe::DataFrameWriteOptions;
use datafusion::datasource::MemTable;
use datafusion::prelude::{ParquetReadOptions, SessionConfig, SessionContext};
use futures::StreamExt;
use std::sync::Arc;

articulated::robot! {
    pub mod arm { urdf = "../models/urdf/panda_like.urdf", functions = [inverse_dynamics], batch = [f64] }
}

const URDF: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf/panda_like.urdf");
/// Rows of a batch: what DataFusion takes unless told otherwise.
const BATCH: usize = 8192;
const BATCHES: usize = 64;
const REPETITIONS: usize = 31;

type Error = Box<dyn std::error::Error + Send + Sync>;
type State = [f64; arm::NV];

/// Any states: a low-discrepancy sequence in ±1.
fn states(of: usize, first: usize) -> Vec<State> {
    let number = |i: usize, k: usize| (((i + 1) as f64 * (k + 2) as f64).sqrt().fract() - 0.5) * 2.0;
    (first..first + BATCH).map(|i| std::array::from_fn(|k| number(i, of * arm::NV + k))).collect()
}

fn list(states: &[State]) -> Result<ArrayRef, Error> {
    let field = Arc::new(Field::new_list_field(DataType::Float64, true));
    let numbers = Arc::new(Float64Array::from(states.as_flattened().to_vec()));
    Ok(Arc::new(FixedSizeListArray::try_new(field, i32::try_from(arm::NV)?, numbers, None)?))
}

/// The median number of rows per second.
fn rows_per_second(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    (BATCH * BATCHES) as f64 / seconds[seconds.len() / 2]
}

fn measured(repetitions: usize, mut run: impl FnMut() -> Result<(), Error>) -> Result<f64, Error> {
    let mut seconds = Vec::with_capacity(repetitions);
    for _ in 0..repetitions {
        let start = Instant::now();
        run()?;
        seconds.push(start.elapsed().as_secs_f64());
    }
    Ok(rows_per_second(seconds))
}

/// The same of a query in a session of one partition; results are dropped as they come.
async fn queried(context: &SessionContext, query: &str, repetitions: usize) -> Result<f64, Error> {
    let mut seconds = Vec::with_capacity(repetitions);
    for _ in 0..repetitions {
        let start = Instant::now();
        let mut stream = context.sql(query).await?.execute_stream().await?;
        let mut rows = 0;
        while let Some(batch) = stream.next().await {
            rows += batch?.num_rows();
        }
        assert!(rows == BATCH * BATCHES || rows <= arm::NV, "{rows} rows");
        seconds.push(start.elapsed().as_secs_f64());
    }
    Ok(rows_per_second(seconds))
}

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Error> {
    let all: Vec<[Vec<State>; 3]> = (0..BATCHES).map(|b| [0, 1, 2].map(|of| states(of, b * BATCH))).collect();
    let model = articulated::load(URDF, Base::Fixed)?;

    let config = SessionConfig::new().with_target_partitions(1);
    let context = SessionContext::new_with_config(config);
    Robot::new(arm::Robot).with_batch("inverse_dynamics", arm::batch_f64::inverse_dynamics)?.register(&context)?;
    Robot::new(model.clone()).prefixed("loaded")?.register(&context)?;
    let mut batches = Vec::with_capacity(BATCHES);
    for states in &all {
        let columns = ["q", "v", "a"].into_iter().zip(states).map(|(name, states)| Ok((name, list(states)?)));
        batches.push(RecordBatch::try_from_iter(columns.collect::<Result<Vec<_>, Error>>()?)?);
    }
    let fields: Vec<Field> = ["q", "v", "a"].map(|name| Field::new(name, batches[0].column(0).data_type().clone(), false)).to_vec();
    let schema = Arc::new(Schema::new(fields));
    let batches: Vec<RecordBatch> =
        batches.into_iter().map(|batch| RecordBatch::try_new(schema.clone(), batch.columns().to_vec())).collect::<Result<_, _>>()?;
    context.register_table("log", Arc::new(MemTable::try_new(schema, vec![batches])?))?;

    let folder = std::env::temp_dir().join(format!("articulated-rows-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let file = folder.join("log.parquet").to_string_lossy().into_owned();
    let options = DataFrameWriteOptions::new().with_single_file_output(true);
    context.table("log").await?.write_parquet(&file, options, None).await?;
    context.register_parquet("file", &file, ParquetReadOptions::default()).await?;

    let mut out = vec![[0.0; arm::NV]; BATCH];
    let batch = measured(REPETITIONS, || {
        for [q, v, a] in &all {
            arm::batch_f64::inverse_dynamics(q, v, a, &mut out)?;
            std::hint::black_box(&mut out);
        }
        Ok(())
    })?;
    let mut ws = model.workspace();
    let library = measured(REPETITIONS / 4, || {
        for [q, v, a] in &all {
            for (((q, v), a), out) in q.iter().zip(v).zip(a).zip(&mut out) {
                model.inverse_dynamics(&mut ws, q, v, a, out)?;
            }
            std::hint::black_box(&mut out);
        }
        Ok(())
    })?;
    let residuals = |name: &str, table: &str| {
        format!(
            "SELECT joint, avg(abs(t)) FROM (SELECT unnest(joint_names()) AS joint, unnest({name}(q, v, a)) AS t FROM {table}) GROUP BY joint"
        )
    };
    let rows = [
        ("generated: the batch function alone", batch, batch),
        ("  SELECT inverse_dynamics(q, v, a)", queried(&context, "SELECT inverse_dynamics(q, v, a) FROM log", REPETITIONS).await?, batch),
        ("  the same from Parquet", queried(&context, "SELECT inverse_dynamics(q, v, a) FROM file", REPETITIONS / 4).await?, batch),
        ("  mean per joint", queried(&context, &residuals("inverse_dynamics", "log"), REPETITIONS / 4).await?, batch),
        ("loaded: the library alone", library, library),
        (
            "  SELECT loaded_inverse_dynamics(q, v, a)",
            queried(&context, "SELECT loaded_inverse_dynamics(q, v, a) FROM log", REPETITIONS / 4).await?,
            library,
        ),
        ("  mean per joint", queried(&context, &residuals("loaded_inverse_dynamics", "log"), REPETITIONS / 4).await?, library),
    ];
    println!("{:<42} {:>14} {:>6}", "one thread", "million rows/s", "ratio");
    for (what, rate, whole) in rows {
        println!("{what:<42} {:>14.2} {:>6.2}", rate / 1e6, rate / whole);
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}
