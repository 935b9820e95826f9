//! Cases for the macro `robot!`: `pass` compiles and runs, `fail` gives the messages in the
//! adjacent files.
