//! One page that needs nothing but itself: no network, no script or style from elsewhere.

mod convergence;
mod elements;
mod features;
mod pictures;
pub mod plot;
mod speed;

pub use convergence::{convergence_csv, convergence_page, convergence_text};
pub use features::{features_csv, features_page, features_text};
pub use speed::{speed_csv, speed_page, speed_text};
