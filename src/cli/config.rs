//! Options from a TOML file: keys are the long options, and the command line wins over them.

use std::collections::BTreeMap;
use std::error::Error as _;
use std::ffi::OsString;
use std::path::Path;

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use radiosity::Error;
use toml::{Spanned, Value};

use super::failure::Failure;

/// Options that a file may not hold.
const NOT_IN_FILES: [&str; 1] = ["config"];

/// `arguments` of a subcommand, with what the file at `path` adds to them.
pub(crate) fn merged(
    command: &Command,
    mut arguments: Vec<OsString>,
    path: &Path,
) -> Result<Vec<OsString>, Failure> {
    let matches = command.clone().try_get_matches_from(&arguments)?;
    let Some((name, given)) = matches.subcommand() else {
        return Ok(arguments);
    };
    let Some(subcommand) = command.find_subcommand(name) else {
        return Ok(arguments);
    };
    let file = ConfigFile { subcommand, given, path, text: read(path)? };
    let added = file.arguments().map_err(Failure::Usage)?;
    // After the program's and the subcommand's name.
    arguments.splice(2..2, added.into_iter().map(OsString::from));
    Ok(arguments)
}

fn read(path: &Path) -> Result<String, Failure> {
    Ok(std::fs::read_to_string(path).map_err(Error::io(path))?)
}

/// A configuration file, and what it may say.
struct ConfigFile<'a> {
    subcommand: &'a Command,
    given: &'a ArgMatches,
    path: &'a Path,
    text: String,
}

impl ConfigFile<'_> {
    /// What the file says, as arguments, without what the command line says otherwise.
    fn arguments(&self) -> Result<Vec<String>, Error> {
        let parsed: Result<BTreeMap<Spanned<String>, Value>, _> = toml::from_str(&self.text);
        let entries = parsed.map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            self.wrong(start, error.message().to_owned())
        })?;
        let mut arguments = Vec::new();
        for (key, value) in &entries {
            let wrong = |message| self.wrong(key.span().start, message);
            let option = self.option(key.get_ref()).map_err(wrong)?;
            let added = written(option, key.get_ref(), value)
                .map_err(|message| wrong(format!("{}: {message}", key.get_ref())))?;
            if !self.is_settled(option) {
                arguments.extend(added);
            }
        }
        Ok(arguments)
    }

    /// An error at a byte of the file.
    fn wrong(&self, start: usize, message: String) -> Error {
        let line = 1 + self.text.bytes().take(start).filter(|&byte| byte == b'\n').count();
        Error::at_line(self.path, line, message)
    }

    fn option(&self, key: &str) -> Result<&Arg, String> {
        let known = || {
            let options = self.subcommand.get_arguments();
            options
                .filter_map(|option| Some((option.get_long()?, option)))
                .filter(|(name, _)| !NOT_IN_FILES.contains(name))
        };
        let found = known().find(|&(name, _)| name == key);
        found.map(|(_, option)| option).ok_or_else(|| {
            let names: Vec<&str> = known().map(|(name, _)| name).collect();
            format!("unknown key \"{key}\"; use one of {}", names.join(", "))
        })
    }

    /// True if the command line gives the option itself, or one that excludes it.
    fn is_settled(&self, option: &Arg) -> bool {
        let is_given = |option: &Arg| {
            self.given.value_source(option.get_id().as_str()) == Some(ValueSource::CommandLine)
        };
        let excluding = self.subcommand.get_arg_conflicts_with(option);
        is_given(option) || excluding.into_iter().any(is_given)
    }
}

/// A key and its value as arguments.
fn written(option: &Arg, key: &str, value: &Value) -> Result<Vec<String>, String> {
    let flag = format!("--{key}");
    let may_be_bare = option.get_num_args().is_some_and(|range| range.min_values() == 0);
    match (option.get_action(), value) {
        (ArgAction::Count, &Value::Integer(count @ 0..=9)) => Ok(vec![flag; count as usize]),
        (ArgAction::Count, _) => Err("write a number, 0 to 9".to_owned()),
        (ArgAction::SetTrue, &Value::Boolean(on)) => Ok(vec![flag; usize::from(on)]),
        (ArgAction::SetTrue, _) => Err("write true or false".to_owned()),
        (_, &Value::Boolean(on)) if may_be_bare => Ok(vec![flag; usize::from(on)]),
        (ArgAction::Append, Value::Array(items)) => {
            let one = |item| Ok(format!("{flag}={}", checked(option, plain(item)?)?));
            items.iter().map(one).collect()
        }
        (_, Value::Array(items)) => {
            let parts: Result<Vec<String>, String> = items.iter().map(plain).collect();
            Ok(vec![format!("{flag}={}", checked(option, parts?.join(","))?)])
        }
        (_, value) => Ok(vec![format!("{flag}={}", checked(option, plain(value)?)?)]),
    }
}

fn plain(value: &Value) -> Result<String, String> {
    match value {
        Value::String(text) => Ok(text.clone()),
        Value::Integer(number) => Ok(number.to_string()),
        Value::Float(number) => Ok(number.to_string()),
        _ => Err("write a number or a text in quotes".to_owned()),
    }
}

/// `text` if it is a value of the option.
fn checked(option: &Arg, text: String) -> Result<String, String> {
    let parser = option.get_value_parser().clone();
    let value = Arg::new("value").value_parser(parser).ignore_case(option.is_ignore_case_set());
    let alone = Command::new("").no_binary_name(true).arg(value.allow_hyphen_values(true));
    match alone.try_get_matches_from([&text]) {
        Ok(_) => Ok(text),
        Err(error) => Err(match error.source() {
            Some(source) => format!("\"{text}\": {source}"),
            None => format!("\"{text}\" is none of its values"),
        }),
    }
}
