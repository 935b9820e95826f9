//! Functions of robots on a Ballista cluster: the same queries, on many machines.
//!
//! Ballista sends a query with the names of its functions. So the scheduler and each executor must
//! know the robots. Each is a program of a few lines:
//!
//! ```no_run
//! use std::sync::Arc;
//!
//! use articulated::Base;
//! use articulated_datafusion::Robot;
//! use articulated_datafusion_cluster::{executor_config, scheduler_config};
//! use ballista_executor::executor_process::{ExecutorProcessConfig, start_executor_process};
//! use ballista_scheduler::cluster::BallistaCluster;
//! use ballista_scheduler::scheduler_process::start_server;
//!
//! async fn scheduler() -> Result<(), Box<dyn std::error::Error>> {
//!     let config = scheduler_config(&[Robot::load("arm.urdf", Base::Fixed)?]);
//!     let cluster = BallistaCluster::new_from_config(&config).await?;
//!     Ok(start_server(cluster, "0.0.0.0:50050".parse()?, Arc::new(config)).await?)
//! }
//!
//! async fn executor() -> Result<(), Box<dyn std::error::Error>> {
//!     let config = ExecutorProcessConfig {
//!         bind_host: "0.0.0.0".into(),
//!         scheduler_host: "scheduler.example".into(),
//!         ..executor_config(&[Robot::load("arm.urdf", Base::Fixed)?])
//!     };
//!     Ok(start_executor_process(Arc::new(config)).await?)
//! }
//! ```
//!
//! The client registers the robots in the session that it gets:
//!
//! ```no_run
//! use articulated::Base;
//! use articulated_datafusion::Robot;
//! use ballista::prelude::SessionContextExt;
//! use datafusion::prelude::SessionContext;
//!
//! async fn client() -> Result<SessionContext, Box<dyn std::error::Error>> {
//!     let context = SessionContext::remote("df://scheduler.example:50050").await?;
//!     Robot::load("arm.urdf", Base::Fixed)?.register(&context)?;
//!     Ok(context)
//! }
//! ```
//!
//! A robot whose prefix or file differs between the machines computes other numbers there: all load
//! the same file.

use std::sync::Arc;

use articulated_datafusion::Robot;
use ballista_core::registry::BallistaFunctionRegistry;
use ballista_core::utils::default_session_builder;
use ballista_executor::executor_process::ExecutorProcessConfig;
use ballista_scheduler::config::SchedulerConfig;
use datafusion::execution::FunctionRegistry;
use datafusion::logical_expr::ScalarUDF;

fn functions(robots: &[Robot]) -> Vec<Arc<ScalarUDF>> {
    robots.iter().flat_map(Robot::functions).map(Arc::new).collect()
}

/// The default configuration of a scheduler, and the functions of these robots.
pub fn scheduler_config(robots: &[Robot]) -> SchedulerConfig {
    let functions = functions(robots);
    SchedulerConfig::default().with_override_session_builder(Arc::new(move |config| {
        let mut state = default_session_builder(config)?;
        for function in &functions {
            state.register_udf(Arc::clone(function))?;
        }
        Ok(state)
    }))
}

/// The default configuration of an executor, and the functions of these robots.
pub fn executor_config(robots: &[Robot]) -> ExecutorProcessConfig {
    let mut registry = BallistaFunctionRegistry::default();
    registry.scalar_functions.extend(functions(robots).into_iter().map(|function| (function.name().to_owned(), function)));
    ExecutorProcessConfig { override_function_registry: Some(Arc::new(registry)), ..ExecutorProcessConfig::default() }
}
