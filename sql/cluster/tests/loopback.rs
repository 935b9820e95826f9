//! The query of the example, on a scheduler and two executors of this process and on none.

use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use articulated_datafusion::Robot;
use articulated_datafusion_cluster::{executor_config, scheduler_config};
use ballista::prelude::SessionContextExt;
use ballista_executor::executor_process::{ExecutorProcessConfig, start_executor_process};
use ballista_scheduler::cluster::BallistaCluster;
use ballista_scheduler::config::SchedulerConfig;
use ballista_scheduler::scheduler_process::start_server;
use datafusion::arrow::array::{AsArray, RecordBatch};
use datafusion::arrow::compute::{cast, concat_batches};
use datafusion::arrow::datatypes::{DataType, Float64Type};
use datafusion::prelude::{ParquetReadOptions, SessionContext};

#[path = "../../examples/fleet/mod.rs"]
mod fleet;

/// No part of the test takes as long.
const LONGEST: Duration = Duration::from_secs(120);

/// A folder that goes with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("articulated-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A port of the loopback interface that is free now.
fn free_port() -> u16 {
    TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port()
}

/// Starts a scheduler and two executors; they end with the runtime of the test.
async fn start(robots: &[Robot], work: &Path) -> String {
    let port = free_port();
    let config = SchedulerConfig { external_host: "127.0.0.1".into(), bind_port: port, ..scheduler_config(robots) };
    let cluster = BallistaCluster::new_from_config(&config).await.unwrap();
    tokio::spawn(async move { start_server(cluster, (Ipv4Addr::LOCALHOST, port).into(), Arc::new(config)).await.unwrap() });
    for name in ["first", "second"] {
        let folder = work.join(name);
        std::fs::create_dir_all(&folder).unwrap();
        let config = ExecutorProcessConfig {
            external_host: Some("127.0.0.1".into()),
            port: free_port(),
            grpc_port: free_port(),
            scheduler_host: "127.0.0.1".into(),
            scheduler_port: port,
            scheduler_connect_timeout_seconds: 30,
            vcores: 2,
            work_dir: Some(folder.to_string_lossy().into_owned()),
            ..executor_config(robots)
        };
        tokio::spawn(async move { start_executor_process(Arc::new(config)).await.unwrap() });
    }
    format!("df://127.0.0.1:{port}")
}

/// A session of the cluster, as soon as the scheduler answers.
async fn connected(url: &str) -> SessionContext {
    let (_, port) = url.rsplit_once(':').unwrap();
    let answers = async {
        while tokio::net::TcpStream::connect(("127.0.0.1", port.parse().unwrap())).await.is_err() {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    };
    tokio::time::timeout(LONGEST, answers).await.unwrap();
    SessionContext::remote(url).await.unwrap()
}

async fn residuals(context: &SessionContext, logs: &Path) -> RecordBatch {
    context.register_parquet("log", logs.to_string_lossy(), ParquetReadOptions::default()).await.unwrap();
    let batches = context.sql(fleet::RESIDUALS).await.unwrap().collect().await.unwrap();
    concat_batches(&batches[0].schema(), &batches).unwrap()
}

fn texts(batch: &RecordBatch, column: usize) -> Vec<String> {
    let texts = cast(batch.column(column), &DataType::Utf8).unwrap();
    texts.as_string::<i32>().iter().map(|text| text.unwrap().to_owned()).collect()
}

fn numbers(batch: &RecordBatch, column: usize) -> Vec<f64> {
    batch.column(column).as_primitive::<Float64Type>().values().to_vec()
}

#[tokio::test(flavor = "multi_thread", worker_threads = 4)]
async fn a_cluster_computes_what_one_process_computes() {
    let (logs, work) = (Folder::new("logs"), Folder::new("work"));
    fleet::write_logs(&logs.0, 2000).await.unwrap();
    let robot = fleet::robot().unwrap();

    let alone = SessionContext::new();
    robot.register(&alone).unwrap();
    let expected = residuals(&alone, &logs.0).await;
    assert_eq!(expected.num_rows(), 21);

    let cluster = connected(&start(std::slice::from_ref(&robot), &work.0).await).await;
    robot.register(&cluster).unwrap();
    let found = tokio::time::timeout(LONGEST, residuals(&cluster, &logs.0)).await.unwrap();

    for column in [0, 1] {
        assert_eq!(texts(&found, column), texts(&expected, column));
    }
    // Sums of partitions come in any order.
    for (found, expected) in numbers(&found, 2).into_iter().zip(numbers(&expected, 2)) {
        assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1e-3), "{found} {expected}");
    }
    assert_eq!(numbers(&found, 3), numbers(&expected, 3));
    // Friction of 4 N·m at the fourth joint of the second robot, and no error of the first.
    assert!((numbers(&found, 2)[7 + 3] - 4.0).abs() < 1e-9 && numbers(&found, 3)[..7].iter().all(|x| *x < 1e-9));
}

/// The functions are computed by the cluster and not by the client.
#[tokio::test(flavor = "multi_thread", worker_threads = 4)]
async fn a_cluster_that_does_not_know_the_robot_names_the_function() {
    let (logs, work) = (Folder::new("logs-without"), Folder::new("work-without"));
    fleet::write_logs(&logs.0, 10).await.unwrap();
    let cluster = connected(&start(&[], &work.0).await).await;
    fleet::robot().unwrap().register(&cluster).unwrap();
    cluster.register_parquet("log", logs.0.to_string_lossy(), ParquetReadOptions::default()).await.unwrap();
    let frame = cluster.sql(fleet::RESIDUALS).await.unwrap();
    let error = tokio::time::timeout(LONGEST, frame.collect()).await.unwrap().unwrap_err().to_string();
    assert!(error.contains("not provided for scalar function inverse_dynamics"), "{error}");
}
