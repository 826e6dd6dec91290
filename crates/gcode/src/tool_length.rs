//! Executes the codes of tools' offsets: G43, G43.1, G43.2, G49, and G10 L1 and L10, which change
//! the tool table while the program runs.

use crate::canon::{AXES, Point};
use crate::codes::Code;
use crate::error::{ErrorKind, Fault};
use crate::motion::Mover;
use crate::tools::{LAST_TOOL, TOOL_RANGE, Tool};

impl Mover<'_> {
    /// G43, G43.1, G43.2 and G49.
    pub(crate) fn tool_length(&mut self, code: Code) -> Result<(), Fault> {
        let old = self.state.frame.tool;
        let by = |offset: Point| std::array::from_fn(|axis| old[axis] + offset[axis]);
        let offset = match code.tenths {
            430 => self.offset_of_tool(code)?,
            431 => self.offset_words(code, old)?,
            432 if self.request.has(b'h') && self.has_axis_words() => {
                let (first, second) = ("H".to_owned(), "axis words".to_owned());
                return Err(Fault::new(code.column, ErrorKind::SameGroup { first, second }));
            }
            432 if self.request.has(b'h') => by(self.offset_of_tool(code)?),
            432 => by(self.offset_words(code, [0.0; AXES])?),
            _ => [0.0; AXES],
        };
        self.near(&offset)?;
        self.state.frame.tool = offset;
        self.state.refresh_frame();
        Ok(())
    }

    /// The offset of tool H, or of the tool in the spindle.
    fn offset_of_tool(&mut self, code: Code) -> Result<Point, Fault> {
        let at = self.request.fault(b'h', ErrorKind::ToolZero).column;
        let number = match self.request.take_whole(b'h', LAST_TOOL, TOOL_RANGE)? {
            // LinuxCNC takes the tool in the spindle, Fanuc's controls take no offset.
            Some(0) => return Err(Fault::new(at, ErrorKind::ToolZero)),
            Some(number) => number,
            None => self.state.modal.tool,
        };
        self.tool(code, number, at).map(|tool| tool.offset)
    }

    /// A tool of the table. Tool 0 is none, and has no length.
    fn tool(&self, code: Code, number: u32, column: u32) -> Result<Tool, Fault> {
        let Some(table) = &self.state.tools else {
            return Err(Fault::new(code.column, ErrorKind::NoToolTable(code.to_string())));
        };
        if number == 0 {
            return Ok(Tool::default());
        }
        let unknown = || Fault::new(column, ErrorKind::UnknownTool(number));
        table.get(number).copied().ok_or_else(unknown)
    }

    /// The offsets that the axis words of the line give, and those of the other axes.
    fn offset_words(&mut self, code: Code, mut offset: Point) -> Result<Point, Fault> {
        if !self.has_axis_words() {
            let kind = ErrorKind::Missing { code: code.to_string(), word: "the offset of an axis" };
            return Err(Fault::new(code.column, kind));
        }
        for (axis, word) in self.axis_values().into_iter().enumerate() {
            offset[axis] = word.unwrap_or(offset[axis]);
        }
        Ok(offset)
    }

    /// G10 L1 and L10: offset and diameter of a tool. With L10 the offset is such that the present
    /// place gets the coordinates of the axis words when the offset of the tool is in effect. The
    /// offset that is in effect does not change before the next G43.
    pub(crate) fn set_tool(&mut self, code: Code, kind: u32) -> Result<(), Fault> {
        let at = self.request.fault(b'p', ErrorKind::ToolZero).column;
        let number = self.request.take_whole(b'p', LAST_TOOL, "1 to 99999")?;
        let missing = ErrorKind::Missing { code: code.to_string(), word: "P, the tool" };
        let number = number.ok_or(Fault::new(code.column, missing))?;
        if number == 0 {
            return Err(self.request.out_of_range(b'p', 0.0, "1 to 99999"));
        }
        let mut tool = self.tool(code, number, at)?;
        if let Some(radius) = self.request.take(b'r') {
            tool.diameter = 2.0 * radius * self.state.unit();
        }
        let words = self.axis_values();
        let mut wanted = self.state.program;
        for (axis, word) in words.into_iter().enumerate() {
            wanted[axis] = word.unwrap_or(wanted[axis]);
        }
        let offset = if kind == 1 {
            wanted
        } else {
            self.state.frame.tool_offset_for(&self.state.machine, &wanted)
        };
        for axis in (0..AXES).filter(|&axis| words[axis].is_some()) {
            tool.offset[axis] = offset[axis];
        }
        self.near(&tool.offset)?;
        if let Some(table) = &mut self.state.tools {
            table.set(number, tool);
        }
        Ok(())
    }
}
