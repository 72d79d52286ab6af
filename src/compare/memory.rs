//! Peak memory of a piece of work, where the system tells.

/// Measures from now on; `None` where the system does not tell.
///
/// Linux keeps the most that has been resident (`VmHWM`), and lets a process set it back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peak {
    before: Option<u64>,
}

impl Peak {
    pub(super) fn start() -> Self {
        let reset = std::fs::write("/proc/self/clear_refs", "5").ok();
        Self { before: reset.and_then(|()| status("VmRSS:")) }
    }

    /// Bytes beyond what was resident at the start.
    pub(super) fn bytes(self) -> Option<u64> {
        Some(status("VmHWM:")?.saturating_sub(self.before?))
    }
}

/// A line of the process's status, bytes.
fn status(name: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
