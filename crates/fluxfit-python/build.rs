//! Where an extension is linked without the interpreter's library (macOS), the linker is told so.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
