//! EDIF, as a vendor's tools get it, read back as Verilog of cells: what is in the file and nothing else.
//!
//! EDIF counts the bits of a port from the left. Which bit of the port that is, only its name says: `step[5:0]`, which yosys
//! writes with `-pvector bra`. A port of many bits whose name does not say it is refused here; ISE guesses.

use crate::SynthesisError;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;

/// One level of brackets, a name or number, a string.
#[derive(Debug)]
enum Node<'a> {
    List(Vec<Node<'a>>),
    Word(&'a str),
    Text(&'a str),
}

/// No bracket is deeper in any file of yosys', and no port wider.
const DEEPEST: usize = 64;
const WIDEST: u32 = 1024;

fn unread(what: impl Into<String>) -> SynthesisError {
    SynthesisError::Unread { tool: "yosys' EDIF", what: what.into() }
}

/// All brackets of a file.
fn parsed(edif: &str) -> Result<Node<'_>, SynthesisError> {
    let mut open = vec![Vec::new()];
    let mut rest = edif;
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '(' if open.len() > DEEPEST => return Err(unread("brackets so deep")),
            '(' => {
                open.push(Vec::new());
                1
            }
            ')' => {
                let list = open.pop().map(Node::List);
                let outer = open.last_mut().ok_or_else(|| unread("a bracket too many"))?;
                outer.extend(list);
                1
            }
            '"' => {
                let end = rest[1..].find('"').ok_or_else(|| unread("the end of a string"))?;
                open.last_mut().ok_or_else(|| unread("a bracket too many"))?.push(Node::Text(&rest[1..=end]));
                end + 2
            }
            space if space.is_whitespace() => space.len_utf8(),
            _ => {
                let end = rest.find(|c: char| c.is_whitespace() || "()\"".contains(c)).unwrap_or(rest.len());
                open.last_mut().ok_or_else(|| unread("a bracket too many"))?.push(Node::Word(&rest[..end]));
                end
            }
        };
        rest = &rest[length..];
    }
    match (open.pop(), open.pop()) {
        (Some(mut top), None) if top.len() == 1 => top.pop().ok_or_else(|| unread("its brackets")),
        _ => Err(unread("the end of a bracket")),
    }
}

impl<'a> Node<'a> {
    fn list(&self) -> &[Self] {
        if let Self::List(list) = self { list } else { &[] }
    }

    fn word(&self) -> Option<&'a str> {
        if let Self::Word(word) = self { Some(word) } else { None }
    }

    /// What a bracket begins with.
    fn head(&self) -> Option<&'a str> {
        self.list().first()?.word()
    }

    /// The brackets in it that begin with a word.
    fn all<'b>(&'b self, head: &'b str) -> impl Iterator<Item = &'b Self> {
        self.list().iter().filter(move |node| node.head() == Some(head))
    }

    /// The first of them.
    fn one(&self, head: &str) -> Result<&Self, SynthesisError> {
        self.list().iter().find(|node| node.head() == Some(head)).ok_or_else(|| unread(head))
    }

    /// `X` or `(rename X "Y")`: by what it is called in the file, and by what before it.
    fn name(&self) -> Result<(&'a str, &'a str), SynthesisError> {
        match self {
            Self::Word(name) => Ok((name, name)),
            Self::List(list) => match list.as_slice() {
                [Self::Word("rename"), Self::Word(name), Self::Text(before)] => Ok((name, before)),
                _ => Err(unread("a name")),
            },
            Self::Text(_) => Err(unread("a name")),
        }
    }

    /// The second thing in a bracket, `(head THIS ...)`.
    fn second(&self) -> Result<&Self, SynthesisError> {
        self.list().get(1).ok_or_else(|| unread("what a bracket is about"))
    }
}

/// A port of a cell, or of the design.
struct Port {
    is_input: bool,
    /// Number of the leftmost bit and of the rightmost, where it has many.
    range: Option<(u32, u32)>,
}

impl Port {
    /// `(port NAME (direction D))`, NAME being `(array NAME COUNT)` where it has many bits.
    fn of<'a>(node: &Node<'a>) -> Result<(&'a str, Self), SynthesisError> {
        let is_input = node.one("direction")?.second()?.word() == Some("INPUT");
        let what = node.second()?;
        if what.head() != Some("array") {
            return Ok((what.name()?.0, Self { is_input, range: None }));
        }
        let (name, before) = what.second()?.name()?;
        let count: Option<u32> = what.list().get(2).and_then(|count| count.word()?.parse().ok());
        let range = before.strip_suffix(']').and_then(|text| text.rsplit_once('[')?.1.split_once(':'));
        let range: Option<(u32, u32)> = range.and_then(|(left, right)| Some((left.parse().ok()?, right.parse().ok()?)));
        match range {
            Some((left, right)) if left.abs_diff(right) < WIDEST && Some(left.abs_diff(right) + 1) == count => {
                Ok((name, Self { is_input, range: Some((left, right)) }))
            }
            _ => Err(unread(format!("which bits {before} has: it was not written with -pvector bra"))),
        }
    }

    /// `[5:0] `, or nothing for a single bit.
    fn verilog(&self) -> String {
        self.range.map_or_else(String::new, |(left, right)| format!("[{left}:{right}] "))
    }

    fn bits(&self) -> u32 {
        self.range.map_or(1, |(left, right)| left.abs_diff(right) + 1)
    }
}

/// The ports of a cell, by name.
type Ports<'a> = BTreeMap<&'a str, Port>;

fn ports<'a>(cell: &Node<'a>) -> Result<Ports<'a>, SynthesisError> {
    cell.one("view")?.one("interface")?.all("port").map(Port::of).collect()
}

/// `(property NAME (integer 8))` or `(property NAME (string "64'h..."))`, as a parameter.
fn parameter(property: &Node<'_>) -> Result<String, SynthesisError> {
    let name = property.second()?.name()?.0;
    let value = property.list().get(2).map(|value| (value.head(), value.list().get(1)));
    match value {
        Some((Some("integer"), Some(Node::Word(number)))) => Ok(format!(".{name}(64'd{number})")),
        // ISE takes a string as what the parameter wants: a Verilog number, or words.
        Some((Some("string"), Some(Node::Text(text)))) if text.contains("'h") => Ok(format!(".{name}({text})")),
        Some((Some("string"), Some(Node::Text(text)))) => Ok(format!(".{name}(\"{text}\")")),
        _ => Err(unread(format!("the property {name}"))),
    }
}

/// Which net each bit of a port is on.
struct Nets<'a> {
    /// Instance, or "" for the design; port; bit from the left.
    places: HashMap<(&'a str, &'a str, u32), u32>,
    /// Nets so far.
    count: u32,
}

impl<'a> Nets<'a> {
    fn of(contents: &Node<'a>) -> Result<Self, SynthesisError> {
        let mut nets = Self { places: HashMap::new(), count: 0 };
        for net in contents.all("net") {
            for joined in net.one("joined")?.all("portRef") {
                let of = joined.one("instanceRef").and_then(Node::second).ok().and_then(Node::word).unwrap_or_default();
                let port = joined.second()?;
                let (port, bit) = match port.list() {
                    [Node::Word("member"), Node::Word(port), Node::Word(bit)] => {
                        (*port, bit.parse().map_err(|_| unread("a bit"))?)
                    }
                    _ => (port.name()?.0, 0),
                };
                if nets.places.insert((of, port, bit), nets.count).is_some() {
                    return Err(unread(format!("on which net bit {bit} of {port} of '{of}' is")));
                }
            }
            nets.count += 1;
        }
        Ok(nets)
    }

    /// The wire of a bit, once; a new one where it was left open.
    fn take(&mut self, of: &'a str, port: &'a str, bit: u32) -> String {
        let net = self.places.remove(&(of, port, bit)).unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        format!("n{net}")
    }
}

/// The design in a file, as Verilog of cells.
///
/// # Errors
/// [`SynthesisError::Unread`]: it is no EDIF of yosys', or does not say which bit is which.
pub fn from_edif(edif: &str) -> Result<String, SynthesisError> {
    let root = parsed(edif)?;
    let mut cells = HashMap::new();
    for cell in root.one("external")?.all("cell") {
        cells.insert(cell.second()?.name()?.0, ports(cell)?);
    }
    let design = root.one("library")?.one("cell")?;
    let (top, own) = (design.second()?.name()?.0, ports(design)?);
    let contents = design.one("view")?.one("contents")?;

    let mut nets = Nets::of(contents)?;

    let mut body = String::new();
    for (name, port) in &own {
        for bit in 0..port.bits() {
            let number = port.range.map(|(left, right)| if left >= right { left - bit } else { left + bit });
            let pin = number.map_or_else(|| (*name).to_owned(), |number| format!("{name}[{number}]"));
            let wire = nets.take("", name, bit);
            // Writing to a string cannot fail.
            let _ = if port.is_input {
                writeln!(body, "assign {wire} = {pin};")
            } else {
                writeln!(body, "assign {pin} = {wire};")
            };
        }
    }
    for instance in contents.all("instance") {
        let name = instance.second()?.name()?.0;
        let cell = instance.one("viewRef")?.one("cellRef")?.second()?.name()?.0;
        let ports = cells.get(cell).ok_or_else(|| unread(format!("the cell {cell}")))?;
        let parameters = instance.all("property").map(parameter).collect::<Result<Vec<_>, _>>()?.join(", ");
        let pins: Vec<String> = ports
            .iter()
            .map(|(port, what)| {
                let bits: Vec<String> = (0..what.bits()).map(|bit| nets.take(name, port, bit)).collect();
                format!(".{port}({{{}}})", bits.join(", "))
            })
            .collect();
        let _ = writeln!(body, "{cell} #({parameters}) {name} ({});", pins.join(", "));
    }
    if let Some((of, port, bit)) = nets.places.keys().next() {
        return Err(unread(format!("bit {bit} of {port} of '{of}', which a net goes to")));
    }
    let heads: Vec<String> = own
        .iter()
        .map(|(name, port)| {
            let way = if port.is_input { "input" } else { "output" };
            format!("    {way} wire {}{name}", port.verilog())
        })
        .collect();
    // One vector of all would be handed on whole by a simulator wherever one bit changes.
    let wires: Vec<String> = (0..nets.count).map(|net| format!("n{net}")).collect();
    Ok(format!("module {top} (\n{}\n);\nwire {};\n{body}endmodule\n", heads.join(",\n"), wires.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::from_edif;

    const TWO_BUFFERS: &str = r#"(edif top (external LIB (cell BUF (view V (interface
        (port (array (rename I "I[1:0]") 2) (direction INPUT)) (port O (direction OUTPUT))))))
        (library DESIGN (cell top (view V (interface
        (port (array (rename a "a[1:0]") 2) (direction INPUT)) (port b (direction OUTPUT)))
        (contents (instance (rename id1 "x.y") (viewRef V (cellRef BUF (libraryRef LIB))) (property INIT (string "4'h8")))
        (net (rename id2 "a[1]") (joined (portRef (member a 0)) (portRef (member I 1) (instanceRef id1))))
        (net b (joined (portRef b) (portRef O (instanceRef id1)))))))))"#;

    #[test]
    fn bits_count_from_the_left() {
        let verilog = from_edif(TWO_BUFFERS).unwrap();
        // The right bit of I is on the left bit of a; nothing is on the other one, nor on the other of a.
        assert!(verilog.contains("assign n0 = a[1];"), "{verilog}");
        assert!(verilog.contains("BUF #(.INIT(4'h8)) id1 (.I({n3, n0}), .O({n1}));"), "{verilog}");
    }

    #[test]
    fn buses_must_say_which_bits_they_have() {
        // As `write_edif` has it without -pvector bra.
        let error = from_edif(&TWO_BUFFERS.replace("I[1:0]", "I")).unwrap_err();
        assert!(error.to_string().contains("-pvector bra"), "{error}");
    }

    #[test]
    fn no_text_hangs_or_panics() {
        for end in 0..TWO_BUFFERS.len() {
            assert!(from_edif(&TWO_BUFFERS[..end]).is_err());
        }
        assert!(from_edif(&TWO_BUFFERS.replace("(member a 0)", "(member a 7)")).is_err());
        assert!(from_edif(&TWO_BUFFERS.replace("I[1:0]", "I[4294967295:0]")).is_err());
        assert!(from_edif(&"(".repeat(1_000_000)).is_err());
    }
}
