//! The curves in which two surfaces meet.
