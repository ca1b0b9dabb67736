//! Which modules a source file refers to: `use` trees and inline paths, comments, strings and tests left out.

/// A path as written, resolved to absolute module segments (without `crate`).
pub(crate) type ModulePath = Vec<String>;

/// Every absolute path that `source`, the file of module `module`, mentions outside its tests.
///
/// `children` are the modules that this file declares: a `use child::X` is a path, too.
pub(crate) fn mentioned_paths(source: &str, module: &[String], children: &[String]) -> Vec<ModulePath> {
    let code = strip(source);
    let code = match code.find("#[cfg(test)]\nmod ") {
        Some(end) => &code[..end],
        None => &code,
    };
    let tokens = tokenize(code);
    let mut paths = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        let preceded_by_path = i > 0 && tokens[i - 1] == "::";
        let is_use = tokens[i] == "use";
        let starts_path = matches!(tokens[i].as_str(), "crate" | "super" | "self")
            && tokens.get(i + 1).is_some_and(|t| t == "::")
            && !preceded_by_path
            // `pub(in crate::x)` limits who may look in; it imports nothing.
            && !(i > 1 && tokens[i - 1] == "in" && tokens[i - 2] == "(");
        if is_use {
            i = use_tree(&tokens, i + 1, &[], &mut paths);
        } else if starts_path {
            let mut path = Vec::new();
            while i < tokens.len() && is_identifier(&tokens[i]) {
                path.push(tokens[i].clone());
                if tokens.get(i + 1).is_none_or(|t| t != "::") {
                    break;
                }
                i += 2;
            }
            paths.push(path);
            i += 1;
        } else {
            i += 1;
        }
    }
    paths.into_iter().filter_map(|p| absolute(&p, module, children)).collect()
}

/// Modules that the file declares with `mod x;`.
pub(crate) fn declared_modules(source: &str) -> Vec<String> {
    let tokens = tokenize(&strip(source));
    tokens.windows(3).filter(|w| w[0] == "mod" && w[2] == ";").map(|w| w[1].clone()).collect()
}

fn use_tree(tokens: &[String], mut i: usize, prefix: &[String], out: &mut Vec<ModulePath>) -> usize {
    let mut path = prefix.to_vec();
    while i < tokens.len() {
        match tokens[i].as_str() {
            "::" => i += 1,
            "{" => {
                i += 1;
                while i < tokens.len() && tokens[i] != "}" {
                    i = use_tree(tokens, i, &path, out);
                    if tokens.get(i).is_some_and(|t| t == ",") {
                        i += 1;
                    }
                }
                return i + 1;
            }
            "as" => i += 2,
            t if is_identifier(t) || t == "*" => {
                path.push(t.to_owned());
                i += 1;
            }
            _ => break,
        }
    }
    out.push(path);
    i
}

fn absolute(path: &[String], module: &[String], children: &[String]) -> Option<ModulePath> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        "crate" => Some(rest.to_vec()),
        "self" => Some([module, rest].concat()),
        "super" => {
            let mut base = module.to_vec();
            let mut rest = path;
            while let Some((head, tail)) = rest.split_first()
                && head == "super"
            {
                base.pop();
                rest = tail;
            }
            Some([&base, rest].concat())
        }
        child if children.iter().any(|c| c == child) => Some([module, path].concat()),
        _ => None,
    }
}

fn is_identifier(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

fn tokenize(code: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut chars = code.chars().peekable();
    while let Some(c) = chars.next() {
        if c.is_alphanumeric() || c == '_' {
            let mut word = String::from(c);
            while let Some(&next) = chars.peek()
                && (next.is_alphanumeric() || next == '_')
            {
                word.push(next);
                chars.next();
            }
            tokens.push(word);
        } else if c == ':' && chars.peek() == Some(&':') {
            chars.next();
            tokens.push("::".to_owned());
        } else if !c.is_whitespace() {
            tokens.push(c.to_string());
        }
    }
    tokens
}

/// The source without comments and string contents, line structure kept.
pub(crate) fn strip(source: &str) -> String {
    let bytes = source.as_bytes();
    let mut out = String::with_capacity(source.len());
    let mut i = 0;
    while i < bytes.len() {
        let rest = &source[i..];
        if rest.starts_with("//") {
            i += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("/*") {
            i += rest.find("*/").map_or(rest.len(), |end| end + 2);
        } else if rest.starts_with("r#\"") {
            i += rest.find("\"#").map_or(rest.len(), |end| end + 2);
        } else if rest.starts_with('"') {
            let mut end = 1;
            while end < rest.len() && !rest[end..].starts_with('"') {
                end += if rest[end..].starts_with('\\') { 2 } else { 1 };
                while end < rest.len() && !rest.is_char_boundary(end) {
                    end += 1;
                }
            }
            out.push_str("\"\"");
            i += (end + 1).min(rest.len());
        } else if rest.starts_with("'\"'") {
            i += 3;
        } else {
            let c = rest.chars().next().unwrap_or(' ');
            out.push(c);
            i += c.len_utf8();
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(source: &str) -> Vec<String> {
        let module = ["light".to_owned(), "point".to_owned()];
        mentioned_paths(source, &module, &["kid".to_owned()]).iter().map(|p| p.join("::")).collect()
    }

    #[test]
    fn use_trees_inline_paths_and_children_are_found() {
        let source = "use crate::{math::{Dir, float::lerp as l}, units::*};\nuse kid::A;\nuse std::fmt;\n\
                      fn f() { super::spot::g(crate::color::cie::y(1.0)); } // crate::never\n\
                      const S: &str = \"crate::not_this\";\n#[cfg(test)]\nmod tests { use crate::render; }";
        assert_eq!(
            paths(source),
            [
                "math::Dir",
                "math::float::lerp",
                "units::*",
                "light::point::kid::A",
                "light::spot::g",
                "color::cie::y"
            ]
        );
    }
}
