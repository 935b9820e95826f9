//! Which robot of a fleet does not move as its model says, and at which joint? SQL over Parquet
//! logs.
//!
//! ```text
//! cargo run --release --example residuals            # writes logs of three robots first
//! cargo run --release --example residuals -- FOLDER  # reads yours: robot, q, v, a, tau
//! ```

use datafusion::arrow::array::{AsArray, RecordBatch};
use datafusion::arrow::datatypes::Float64Type;
use datafusion::arrow::util::display::array_value_to_string;
use datafusion::prelude::{ParquetReadOptions, SessionContext};

mod fleet;

type Error = Box<dyn std::error::Error + Send + Sync>;

fn print(batches: &[RecordBatch]) -> Result<(), Error> {
    println!("{:<8} {:<8} {:>10} {:>13}", "robot", "joint", "mean, N·m", "largest, N·m");
    for batch in batches {
        let text = |k: usize, row| array_value_to_string(batch.column(k), row);
        let number = |k: usize| batch.column(k).as_primitive::<Float64Type>();
        for row in 0..batch.num_rows() {
            let (robot, joint) = (text(0, row)?, text(1, row)?);
            println!("{robot:<8} {joint:<8} {:>10.3} {:>13.3}", number(2).value(row), number(3).value(row));
        }
    }
    Ok(())
}

#[tokio::main]
async fn main() -> Result<(), Error> {
    let temporary = std::env::temp_dir().join(format!("articulated-residuals-{}", std::process::id()));
    let given = std::env::args().nth(1);
    if given.is_none() {
        std::fs::create_dir_all(&temporary)?;
        fleet::write_logs(&temporary, 10_000).await?;
    }
    let folder = given.clone().unwrap_or_else(|| temporary.to_string_lossy().into_owned());

    let context = SessionContext::new();
    fleet::robot()?.register(&context)?;
    context.register_parquet("log", &folder, ParquetReadOptions::default()).await?;
    print(&context.sql(fleet::RESIDUALS).await?.collect().await?)?;

    if given.is_none() {
        std::fs::remove_dir_all(&temporary)?;
    }
    Ok(())
}
