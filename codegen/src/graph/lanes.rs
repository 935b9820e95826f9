//! Values with one number per lane, in a graph whose values are vectors.

use std::collections::HashMap;

/// Largest number of lanes of a graph.
pub const MOST: usize = 4;

/// The value of a node in each lane; beyond the width of the graph, as in lane 0.
pub type Value = [f64; MOST];

/// The tables behind lane constants and lane inputs.
#[derive(Clone, Debug)]
pub struct Lanes {
    /// How many lanes each value has: 1 in a graph of plain numbers.
    pub width: usize,
    constants: Vec<Value>,
    places: HashMap<[u64; MOST], u32>,
    inputs: Vec<[u32; MOST]>,
}

impl Default for Lanes {
    fn default() -> Self {
        Self::new(1)
    }
}

impl Lanes {
    /// Empty tables.
    pub fn new(width: usize) -> Self {
        Self { width, constants: Vec::new(), places: HashMap::new(), inputs: Vec::new() }
    }

    /// A lane constant.
    pub fn constant(&self, number: u32) -> Value {
        self.constants[number as usize]
    }

    /// The indices of a lane input.
    pub fn input(&self, number: u32) -> &[u32] {
        &self.inputs[number as usize][..self.width]
    }

    /// The number of a lane constant.
    pub(crate) fn add_constant(&mut self, x: Value) -> u32 {
        let next = self.constants.len() as u32;
        let number = *self.places.entry(x.map(f64::to_bits)).or_insert(next);
        if number == next {
            self.constants.push(x);
        }
        number
    }

    /// The number of a lane input.
    pub(crate) fn add_input(&mut self, indices: &[usize]) -> u32 {
        let padded = std::array::from_fn(|k| *indices.get(k).unwrap_or(&indices[0]) as u32);
        match self.inputs.iter().position(|i| *i == padded) {
            Some(number) => number as u32,
            None => {
                self.inputs.push(padded);
                self.inputs.len() as u32 - 1
            }
        }
    }
}
