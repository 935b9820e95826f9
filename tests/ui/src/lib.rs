//! Cases for the macro `robot!`: `pass` compiles and runs, `fail` says what stands beside it.
