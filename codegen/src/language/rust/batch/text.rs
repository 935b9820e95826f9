//! Parts of generated batches besides bodies.

/// Helpers of batch bodies.
pub(super) const SUPPORT: &str = "\
macro_rules! batch_support {
    ($(#[$features:meta])?) => {
        /// How many vectors a block has of each number.
        const PARTS: usize = Lanes::LEN / LANES;

        $(#[$features])?
        #[inline]
        fn at(from: &Lanes, part: usize) -> V {
            load(&from.0.as_chunks::<LANES>().0[part])
        }

        $(#[$features])?
        #[inline]
        fn put(to: &mut Lanes, part: usize, x: V) {
            store(x, &mut to.0.as_chunks_mut::<LANES>().0[part]);
        }

        /// States one after the other as a block.
        $(#[$features])?
        #[inline]
        fn gather<const N: usize>(states: &[[Real; N]; Lanes::LEN], block: &mut [Lanes; N]) {
            if N == 1 {
                return block[0].0.copy_from_slice(states.as_flattened());
            }
            for part in 0..Lanes::LEN / STATES {
                let states = &states.as_chunks::<STATES>().0[part];
                let mut done = 0;
                while WIDE > TILE && N >= WIDE && done + TILE < N {
                    // The last tile is full too: some numbers are in two.
                    let first = done.min(N - WIDE);
                    take(&wide_columns(states, first), block, first, part);
                    done = first + WIDE;
                }
                while done < N {
                    let first = done.min(N.saturating_sub(TILE));
                    take(&columns(states, first), block, first, part);
                    done = first + TILE;
                }
            }
        }

        /// A block as states one after the other.
        $(#[$features])?
        #[inline]
        fn scatter<const N: usize>(block: &[Lanes; N], states: &mut [[Real; N]; Lanes::LEN]) {
            if N == 1 {
                return states.as_flattened_mut().copy_from_slice(&block[0].0);
            }
            for part in 0..Lanes::LEN / STATES {
                let states = &mut states.as_chunks_mut::<STATES>().0[part];
                let mut done = 0;
                while WIDE > TILE && N >= WIDE && done + TILE < N {
                    let first = done.min(N - WIDE);
                    wide_rows(&tile(block, first, part), states, first);
                    done = first + WIDE;
                }
                while done < N {
                    let first = done.min(N.saturating_sub(TILE));
                    rows(&tile(block, first, part), states, first);
                    done = first + TILE;
                }
            }
        }

        /// Puts numbers `first` and on of some states into their block.
        $(#[$features])?
        #[inline]
        fn take<const N: usize, const T: usize>(tile: &[[Real; STATES]; T], block: &mut [Lanes; N], first: usize, part: usize) {
            for (column, lanes) in tile.iter().zip(&mut block[first..]) {
                lanes.0.as_chunks_mut::<STATES>().0[part] = *column;
            }
        }

        /// Numbers `first` and on of some states of a block.
        $(#[$features])?
        #[inline]
        fn tile<const N: usize, const T: usize>(block: &[Lanes; N], first: usize, part: usize) -> [[Real; STATES]; T] {
            let mut tile = [[0.0; STATES]; T];
            for (column, lanes) in tile.iter_mut().zip(&block[first..]) {
                *column = lanes.0.as_chunks::<STATES>().0[part];
            }
            tile
        }

        /// The last states. The very last fills the block.
        #[inline(never)]
        fn filled<const N: usize>(states: &[[Real; N]]) -> [[Real; N]; Lanes::LEN] {
            let mut filled = [[0.0; N]; Lanes::LEN];
            for (lane, state) in filled.iter_mut().enumerate() {
                *state = states[lane.min(states.len() - 1)];
            }
            filled
        }

        /// The first states of a block.
        #[inline(never)]
        fn scatter_some<const N: usize>(block: &[Lanes; N], states: &mut [[Real; N]]) {
            for (lane, state) in states.iter_mut().enumerate() {
                for k in 0..N {
                    state[k] = block[k].0[lane];
                }
            }
        }
    };
}

";

/// Public items of the module besides the functions.
pub(super) const PUBLIC: &str = "\
    /// One number of each state of a block.
    #[repr(align(64))]
    #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq)]
    pub struct Lanes(pub [REAL; BLOCK]);

    impl Lanes {
        /// Number of states of a block.
        pub const LEN: usize = BLOCK;
        /// Zero in every state.
        pub const ZERO: Self = Self([0.0; BLOCK]);

        /// Number of blocks for so many states.
        pub const fn blocks(states: usize) -> usize {
            states.div_ceil(Self::LEN)
        }

        /// Packs states into blocks: number k of state `LEN`·b + i is `blocks[b][k].0[i]`. The last
        /// block is filled up with its last state.
        ///
        /// # Errors
        /// If there are not [`Lanes::blocks`] of the states: nothing is written.
        pub fn pack<const N: usize>(states: &[[REAL; N]], blocks: &mut [[Self; N]]) -> ::core::result::Result<(), LengthError> {
            LengthError::unless(\"blocks\", blocks.len(), Self::blocks(states.len()))?;
            for (states, block) in ::core::iter::Iterator::zip(states.chunks(Self::LEN), blocks) {
                for (k, lanes) in ::core::iter::Iterator::enumerate(block.iter_mut()) {
                    *lanes = Self(::core::array::from_fn(|i| states[if i < states.len() { i } else { states.len() - 1 }][k]));
                }
            }
            ::core::result::Result::Ok(())
        }

        /// The states of the blocks, without what fills the last block.
        ///
        /// # Errors
        /// As [`Lanes::pack`].
        pub fn unpack<const N: usize>(blocks: &[[Self; N]], states: &mut [[REAL; N]]) -> ::core::result::Result<(), LengthError> {
            LengthError::unless(\"blocks\", blocks.len(), Self::blocks(states.len()))?;
            for (i, state) in ::core::iter::Iterator::enumerate(states.iter_mut()) {
                *state = ::core::array::from_fn(|k| blocks[i / Self::LEN][k].0[i % Self::LEN]);
            }
            ::core::result::Result::Ok(())
        }
    }

    /// Slices of different lengths.
    #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq, ::core::cmp::Eq)]
    pub struct LengthError {
        /// The argument.
        pub argument: &'static str,
        /// Its length.
        pub found: usize,
        /// The length that it must have, which follows from the first argument.
        pub expected: usize,
    }

    impl LengthError {
        fn unless(argument: &'static str, found: usize, expected: usize) -> ::core::result::Result<(), Self> {
            if found == expected { ::core::result::Result::Ok(()) } else { ::core::result::Result::Err(Self { argument, found, expected }) }
        }
    }

    impl ::core::fmt::Display for LengthError {
        fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
            ::core::write!(f, \"argument {}: found a length of {}, expected {}\", self.argument, self.found, self.expected)
        }
    }

    impl ::core::error::Error for LengthError {}

";
