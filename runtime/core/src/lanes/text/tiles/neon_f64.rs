
use ::core::arch::aarch64::{float64x2_t as Register, vzip1q_f64 as low, vzip2q_f64 as high};
