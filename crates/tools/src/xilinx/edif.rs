//! Reads EDIF, as the tools of a vendor receive it, and converts it to Verilog of cells without
//! adding anything.
//!
//! EDIF counts the bits of a port from the left. Only the port's name says which bits these are:
//! `step[5:0]`, as yosys writes it with `-pvector bra`. A port of several bits whose name does not
//! contain the range is refused here; ISE would guess.
//!
//! By hand, because only the subset that yosys writes is read, and whatever else occurs is refused.

use crate::SynthesisError;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;

/// A list in parentheses, a name or number, or a string.
#[derive(Debug)]
enum Node<'a> {
    List(Vec<Node<'a>>),
    Word(&'a str),
    Text(&'a str),
}

/// Greatest depth of parentheses and greatest width of ports; no file of yosys exceeds it.
const DEEPEST: usize = 64;
const WIDEST: u32 = 1024;

fn unread(what: impl Into<String>) -> SynthesisError {
    SynthesisError::Unread { tool: "yosys' EDIF", what: what.into() }
}

/// Parses a whole file.
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
                open.last_mut()
                    .ok_or_else(|| unread("a bracket too many"))?
                    .push(Node::Text(&rest[1..=end]));
                end + 2
            }
            space if space.is_whitespace() => space.len_utf8(),
            _ => {
                let end = rest
                    .find(|c: char| c.is_whitespace() || "()\"".contains(c))
                    .unwrap_or(rest.len());
                open.last_mut()
                    .ok_or_else(|| unread("a bracket too many"))?
                    .push(Node::Word(&rest[..end]));
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

    /// The first word of a list.
    fn head(&self) -> Option<&'a str> {
        self.list().first()?.word()
    }

    /// The lists within it that begin with a word.
    fn all<'b>(&'b self, head: &'b str) -> impl Iterator<Item = &'b Self> {
        self.list().iter().filter(move |node| node.head() == Some(head))
    }

    /// The first of these lists.
    fn one(&self, head: &str) -> Result<&Self, SynthesisError> {
        self.list().iter().find(|node| node.head() == Some(head)).ok_or_else(|| unread(head))
    }

    /// The name in the file and the original name: `X` or `(rename X "Y")`.
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

    /// The second element of a list, `(head THIS ...)`.
    fn second(&self) -> Result<&Self, SynthesisError> {
        self.list().get(1).ok_or_else(|| unread("what a bracket is about"))
    }
}

/// A port of a cell or of the design.
struct Port {
    is_input: bool,
    /// Numbers of the leftmost and of the rightmost bit, if the port has several bits.
    range: Option<(u32, u32)>,
}

impl Port {
    /// Reads `(port NAME (direction D))`; with several bits NAME is `(array NAME COUNT)`.
    fn of<'a>(node: &Node<'a>) -> Result<(&'a str, Self), SynthesisError> {
        let is_input = node.one("direction")?.second()?.word() == Some("INPUT");
        let what = node.second()?;
        if what.head() != Some("array") {
            return Ok((what.name()?.0, Self { is_input, range: None }));
        }
        let (name, before) = what.second()?.name()?;
        let count: Option<u32> = what.list().get(2).and_then(|count| count.word()?.parse().ok());
        let range =
            before.strip_suffix(']').and_then(|text| text.rsplit_once('[')?.1.split_once(':'));
        let range: Option<(u32, u32)> =
            range.and_then(|(left, right)| Some((left.parse().ok()?, right.parse().ok()?)));
        match range {
            Some((left, right))
                if left.abs_diff(right) < WIDEST && Some(left.abs_diff(right) + 1) == count =>
            {
                Ok((name, Self { is_input, range: Some((left, right)) }))
            }
            _ => Err(unread(format!(
                "which bits {before} has: it was not written with -pvector bra"
            ))),
        }
    }

    /// The range of a vector, `[5:0] `; empty for a single bit.
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

/// Reads `(property NAME (integer 8))` or `(property NAME (string "64'h..."))` as a Verilog
/// parameter.
fn parameter(property: &Node<'_>) -> Result<String, SynthesisError> {
    let name = property.second()?.name()?.0;
    let value = property.list().get(2).map(|value| (value.head(), value.list().get(1)));
    match value {
        Some((Some("integer"), Some(Node::Word(number)))) => Ok(format!(".{name}(64'd{number})")),
        // ISE interprets a string by the type of the parameter: as a Verilog number, or as text.
        Some((Some("string"), Some(Node::Text(text)))) if text.contains("'h") => {
            Ok(format!(".{name}({text})"))
        }
        Some((Some("string"), Some(Node::Text(text)))) => Ok(format!(".{name}(\"{text}\")")),
        _ => Err(unread(format!("the property {name}"))),
    }
}

/// The net of each bit of a port.
struct Nets<'a> {
    /// Key: instance (empty for the design), port, and number of the bit from the left.
    places: HashMap<(&'a str, &'a str, u32), u32>,
    /// Number of nets so far.
    count: u32,
}

impl<'a> Nets<'a> {
    fn of(contents: &Node<'a>) -> Result<Self, SynthesisError> {
        let mut nets = Self { places: HashMap::new(), count: 0 };
        for net in contents.all("net") {
            for joined in net.one("joined")?.all("portRef") {
                let of = joined
                    .one("instanceRef")
                    .and_then(Node::second)
                    .ok()
                    .and_then(Node::word)
                    .unwrap_or_default();
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

    /// The wire of a bit, which is used once; a new wire if the bit is not connected.
    fn take(&mut self, of: &'a str, port: &'a str, bit: u32) -> String {
        let net = self.places.remove(&(of, port, bit)).unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        format!("n{net}")
    }
}

/// What a design consists of.
pub(super) struct Contents {
    /// How many cells of each kind.
    pub cells: BTreeMap<String, usize>,
    /// The ends of each net in alphabetical order, each as `instance/port/bit`. Bits count from the
    /// left; the design's own ports have no instance.
    pub nets: BTreeSet<String>,
}

/// The cells and nets of a file.
pub(super) fn contents(edif: &str) -> Result<Contents, SynthesisError> {
    let root = parsed(edif)?;
    let contents = root.one("library")?.one("cell")?.one("view")?.one("contents")?;
    let mut cells = BTreeMap::new();
    for instance in contents.all("instance") {
        *cells.entry(cell_of(instance)?.to_owned()).or_default() += 1;
    }
    let mut ends: BTreeMap<u32, Vec<String>> = BTreeMap::new();
    for ((instance, port, bit), net) in Nets::of(contents)?.places {
        ends.entry(net).or_default().push(format!("{instance}/{port}/{bit}"));
    }
    let joined = |mut ends: Vec<String>| {
        ends.sort_unstable();
        ends.join(" ")
    };
    Ok(Contents { cells, nets: ends.into_values().map(joined).collect() })
}

/// The kind of an instance.
fn cell_of<'a>(instance: &Node<'a>) -> Result<&'a str, SynthesisError> {
    Ok(instance.one("viewRef")?.one("cellRef")?.second()?.name()?.0)
}

/// Converts the design of a file to Verilog of cells.
///
/// # Errors
/// [`SynthesisError::Unread`] if the text is not EDIF as yosys writes it, or if the order of a
/// port's bits is not given.
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
            let number =
                port.range.map(|(left, right)| if left >= right { left - bit } else { left + bit });
            let pin =
                number.map_or_else(|| (*name).to_owned(), |number| format!("{name}[{number}]"));
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
        let cell = cell_of(instance)?;
        let ports = cells.get(cell).ok_or_else(|| unread(format!("the cell {cell}")))?;
        let parameters =
            instance.all("property").map(parameter).collect::<Result<Vec<_>, _>>()?.join(", ");
        let pins: Vec<String> = ports
            .iter()
            .map(|(port, what)| {
                let bits: Vec<String> =
                    (0..what.bits()).map(|bit| nets.take(name, port, bit)).collect();
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
    // Each net is a wire of its own. With one vector of all nets, a simulator would propagate the
    // whole vector whenever one bit changes.
    let wires: Vec<String> = (0..nets.count).map(|net| format!("n{net}")).collect();
    Ok(format!(
        "module {top} (\n{}\n);\nwire {};\n{body}endmodule\n",
        heads.join(",\n"),
        wires.join(", ")
    ))
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
    fn bits_are_counted_from_the_left() {
        let verilog = from_edif(TWO_BUFFERS).unwrap();
        // The right bit of I is connected to the left bit of a. The other bits of I and a are open.
        assert!(verilog.contains("assign n0 = a[1];"), "{verilog}");
        assert!(verilog.contains("BUF #(.INIT(4'h8)) id1 (.I({n3, n0}), .O({n1}));"), "{verilog}");
    }

    #[test]
    fn bus_without_a_range_is_refused() {
        // The format of `write_edif` without -pvector bra.
        let error = from_edif(&TWO_BUFFERS.replace("I[1:0]", "I")).unwrap_err();
        assert!(error.to_string().contains("-pvector bra"), "{error}");
    }

    #[test]
    fn malformed_text_neither_hangs_nor_panics() {
        for end in 0..TWO_BUFFERS.len() {
            assert!(from_edif(&TWO_BUFFERS[..end]).is_err());
        }
        assert!(from_edif(&TWO_BUFFERS.replace("(member a 0)", "(member a 7)")).is_err());
        assert!(from_edif(&TWO_BUFFERS.replace("I[1:0]", "I[4294967295:0]")).is_err());
        assert!(from_edif(&"(".repeat(1_000_000)).is_err());
    }
}
