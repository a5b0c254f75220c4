#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fluxfit_fuzz::hold("identification", bytes));
