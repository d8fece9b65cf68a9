//! Values of the command line that are part of the language but do not work yet. They are refused by name, never ignored.

use clap::ValueEnum;
use gpt::scene::setting_name;

use super::arguments::EstimateArguments;
use super::exit::Failure;

/// Flag and value of everything refused.
const UNSUPPORTED: &[(&str, &str)] = &[("--light-sampling", "visible"), ("--light-sampling", "area")];

/// Refuses the first flag whose value is not supported.
///
/// # Errors
/// A usage error that names the flag, the value and the values that work.
pub fn refuse(arguments: &EstimateArguments) -> Result<(), Failure> {
    check("--estimator", arguments.estimator)?;
    check("--heuristic", arguments.heuristic)?;
    check("--light-sampling", arguments.light_sampling)?;
    check("--blend", arguments.blend)
}

fn check<T: ValueEnum>(flag: &'static str, value: Option<T>) -> Result<(), Failure> {
    let Some(value) = value else { return Ok(()) };
    let name = setting_name(value);
    let refused = |name: &str| UNSUPPORTED.contains(&(flag, name));
    if !refused(&name) {
        return Ok(());
    }
    let working: Vec<_> =
        T::value_variants().iter().map(|value| setting_name(value.clone())).filter(|name| !refused(name)).collect();
    let help = (!working.is_empty()).then(|| format!("values that work: {}", working.join(", ")));
    Err(Failure::Usage { message: format!("`{flag} {name}` is not supported yet"), help })
}

#[cfg(test)]
mod tests {
    use gpt::scene::LightSampling;

    use super::*;

    #[test]
    fn what_does_not_work_is_refused_with_what_does() {
        let refused = EstimateArguments { light_sampling: Some(LightSampling::Area), ..EstimateArguments::default() };
        let Err(Failure::Usage { message, help }) = refuse(&refused) else { panic!("not refused") };
        assert_eq!(message, "`--light-sampling area` is not supported yet");
        assert_eq!(help.as_deref(), Some("values that work: cone"));
        let accepted = EstimateArguments { light_sampling: Some(LightSampling::Cone), ..EstimateArguments::default() };
        assert!(refuse(&accepted).is_ok());
    }
}
