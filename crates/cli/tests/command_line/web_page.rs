//! The page of `serve --web` in Chromium, which is driven by its debugging protocol: the page shows
//! where the machine is, its buttons act, a dropped file is executed, and it is readable on a
//! phone's width.

use crate::sender::{Sender, Served};
use crate::serve_streams::folder;
use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tungstenite::{Message, WebSocket};

const PATIENCE: Duration = Duration::from_secs(60);

/// A page in a browser of its own.
struct Browser {
    child: Child,
    socket: WebSocket<TcpStream>,
    session: Value,
    next: u64,
    /// The errors of the page.
    console: Vec<Value>,
    _profile: TempDir,
}

impl Browser {
    /// Opens a page on a phone of 360 x 740 pixels.
    fn open(address: &str) -> Self {
        let profile = tempfile::tempdir().unwrap();
        let mut child = Command::new("chromium")
            .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0"])
            .args(["--disable-background-networking", "--no-first-run", "about:blank"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stderr(Stdio::piped())
            .spawn()
            .expect("chromium is installed: sudo apt-get install chromium");
        let said = BufReader::new(child.stderr.take().unwrap());
        let mut said = said.lines().map(Result::unwrap);
        let listens = |line: String| Some(line.strip_prefix("DevTools listening on ")?.to_owned());
        let debugging = said.find_map(listens).expect("chromium has ended");
        // Otherwise it would wait for somebody who reads.
        std::thread::spawn(move || said.for_each(drop));
        let host = debugging.strip_prefix("ws://").unwrap().split('/').next().unwrap();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(&debugging, stream).unwrap();
        let (session, console) = (Value::Null, Vec::new());
        let mut this = Self { child, socket, session, next: 0, console, _profile: profile };
        let target = this.call("Target.createTarget", &json!({ "url": "about:blank" }));
        let target = json!({ "targetId": target["targetId"], "flatten": true });
        this.session = this.call("Target.attachToTarget", &target)["sessionId"].clone();
        this.call("Runtime.enable", &json!({}));
        this.call("Log.enable", &json!({}));
        let phone = json!({ "width": 360, "height": 740, "deviceScaleFactor": 2, "mobile": true });
        this.call("Emulation.setDeviceMetricsOverride", &phone);
        this.call("Page.navigate", &json!({ "url": address }));
        this
    }

    /// Calls a method of the protocol.
    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.next += 1;
        let mut call = json!({ "id": self.next, "method": method, "params": parameters });
        if !self.session.is_null() {
            call["sessionId"] = self.session.clone();
        }
        self.socket.send(Message::text(call.to_string())).unwrap();
        loop {
            let said = self.socket.read().unwrap();
            let mut said: Value = serde_json::from_slice(&said.into_data()).unwrap();
            if said["id"] == self.next {
                assert!(said["error"].is_null(), "{method}: {said}");
                return said["result"].take();
            }
            let method = said["method"].as_str().unwrap_or_default();
            let is_error = said["params"]["entry"]["level"] == "error";
            if method == "Runtime.exceptionThrown" || method == "Log.entryAdded" && is_error {
                self.console.push(said);
            }
        }
    }

    /// The value of an expression in the page.
    fn value(&mut self, expression: &str) -> Value {
        let asked = json!({ "expression": expression, "returnByValue": true });
        let mut result = self.call("Runtime.evaluate", &asked);
        assert!(result["exceptionDetails"].is_null(), "{expression}: {result}");
        result["result"]["value"].take()
    }

    /// Waits until an expression is true.
    #[track_caller]
    fn waits(&mut self, expression: &str) {
        let begin = Instant::now();
        while self.value(expression) != true {
            let shown = self.value("document.body.innerText");
            assert!(begin.elapsed() < PATIENCE, "{expression}\n{shown}\n{:?}", self.console);
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The text of an element.
    fn text(&mut self, id: &str) -> String {
        let text = self.value(&format!("document.getElementById('{id}').textContent"));
        text.as_str().unwrap().to_owned()
    }

    /// Presses what is where the middle of an element is, as a finger does.
    fn presses(&mut self, id: &str) {
        let at = self.value(&format!(
            "(() => {{ const it = document.getElementById('{id}'); it.scrollIntoView({{ block: \
             'center' }}); const box = it.getBoundingClientRect(); return [box.x + box.width / 2, \
             box.y + box.height / 2]; }})()"
        ));
        for kind in ["mousePressed", "mouseReleased"] {
            let mouse = json!({
                "type": kind, "x": at[0], "y": at[1], "button": "left", "clickCount": 1
            });
            self.call("Input.dispatchMouseEvent", &mouse);
        }
    }

    /// Drops a file with this text on the page.
    fn drops(&mut self, name: &str, text: &str) {
        let (name, text) = (Value::from(name), Value::from(text));
        self.value(&format!(
            "(() => {{ const data = new DataTransfer(); data.items.add(new File([{text}], {name})); \
             document.body.dispatchEvent(new DragEvent('drop', {{ dataTransfer: data, bubbles: true, \
             cancelable: true }})); }})()"
        ));
    }

    /// Waits until more than a hundred pixels of the path's picture have this colour. The browser
    /// paints after the texts have changed.
    #[track_caller]
    fn paints(&mut self, [red, green, blue]: [u8; 3]) {
        self.waits(&format!(
            "(() => {{ const it = document.getElementById('path'); const {{ data }} = \
             it.getContext('2d').getImageData(0, 0, it.width, it.height); let count = 0; for (let k \
             = 0; k < data.length; k += 4) count += data[k] === {red} && data[k + 1] === {green} && \
             data[k + 2] === {blue}; return count > 100; }})()"
        ));
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn is_state(state: &str) -> String {
    format!("document.getElementById('state')?.textContent === '{state}'")
}

#[test]
fn page_shows_the_machine_runs_a_dropped_file_and_stops_it() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let mut page = Browser::open(&served.web);
    page.waits(&is_state("Idle"));
    page.waits("document.querySelectorAll('td.work').length === 3");
    assert_eq!(page.value("document.querySelector('td.work').textContent"), "0.000");
    assert_eq!(page.value("document.documentElement.scrollWidth"), 360);
    assert_eq!(page.text("right"), "");

    // A short program, with what must not act in its comments.
    page.drops(
        "<b>square.nc",
        "G21 G90 F1500 (what? wait!)\nG1 X4\nG1 Y4 ; ~?!\nG2 X0 Y0 I-2 J-2\n",
    );
    page.waits("!document.getElementById('run').disabled");
    assert!(page.text("name").starts_with("<b>square.nc, 4 lines"));
    page.presses("run");
    page.waits("document.getElementById('said').textContent === 'The program is done.'");
    page.waits(&is_state("Idle"));
    assert_eq!(page.text("axes"), "X0.0000.000Y0.0000.000Z0.0000.000");
    // The path of the file, and the tool.
    page.paints([0x8a, 0x94, 0x9e]);
    page.paints([0xe0, 0x20, 0x3f]);

    // A line that is refused is named, and ends the program.
    page.drops("bad.nc", "G21\n\nG1 X1 F100 Q9 W2\nG1 X9\n");
    page.waits("!document.getElementById('run').disabled");
    page.presses("run");
    page.waits("document.getElementById('said').textContent.startsWith('Line 3: error:')");

    // A long way: hold, resume, overrides, stop.
    page.drops("long.nc", "G91 G1 X30 F60");
    page.waits("!document.getElementById('run').disabled");
    page.presses("run");
    page.waits(&is_state("Run"));
    page.presses("hold");
    page.waits(&is_state("Hold:0"));
    page.presses("resume");
    page.waits(&is_state("Run"));
    page.value("document.querySelector('[data-what=feed] button:last-of-type').click()");
    page.waits("document.querySelector('[data-what=feed] b').textContent === '110 %'");
    page.presses("stop");
    page.waits(&is_state("Alarm"));
    assert_eq!(page.text("why"), "stopped on the web page");
    assert_eq!(page.value("document.documentElement.scrollWidth"), 360);
    page.waits("!document.getElementById('unlock').disabled");
    page.presses("unlock");
    page.waits(&is_state("Idle"));
    let stopped = Sender::tcp(&served).place()[0];
    assert!(stopped < 30.0, "{stopped}");
    assert_eq!(page.console, Vec::<Value>::new());
}

#[test]
fn page_without_the_token_says_so_and_stops_what_another_drives() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let (link, _) = served.web.split_once('#').unwrap();
    let mut sender = Sender::tcp(&served);
    sender.simple("G91 G1 X30 F60");
    let mut page = Browser::open(link);
    page.waits(&is_state("Run"));
    assert!(page.text("right").starts_with("This page watches."));
    assert_eq!(page.value("document.querySelectorAll('button:enabled').length"), 1);
    page.presses("stop");
    sender.until(|line| line == "ALARM:3");
    page.waits(&is_state("Alarm"));
    // When the command ends, the page says that too.
    assert_eq!(served.interrupt().0, 0);
    page.waits(&is_state("no connection"));
}

/// Presses a button of the jogs.
fn jogs(page: &mut Browser, way: &str, size: &str, feed: &str) {
    let button = format!("document.querySelector('[data-jog=\"{way}\"]')");
    page.waits(&format!("!{button}.disabled"));
    page.value(&format!("document.getElementById('size').value = '{size}'"));
    page.value(&format!("document.getElementById('jogfeed').value = '{feed}'"));
    page.value(&format!("{button}.click()"));
}

#[test]
fn page_jogs_by_steps_and_shows_the_height() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let mut page = Browser::open(&served.web);
    page.waits(&is_state("Idle"));
    let shows = |axes: &str| format!("document.getElementById('axes').textContent === '{axes}'");
    jogs(&mut page, "X+", "1", "600");
    page.waits(&shows("X1.0001.000Y0.0000.000Z0.0000.000"));
    jogs(&mut page, "Y-", "10", "2000");
    page.waits(&shows("X1.0001.000Y-10.000-10.000Z0.0000.000"));
    jogs(&mut page, "Z-", "0.1", "300");
    page.waits(&shows("X1.0001.000Y-10.000-10.000Z-0.100-0.100"));
    assert_eq!(page.text("height"), "-0.100 mm");
    assert_eq!(page.value("document.documentElement.scrollWidth"), 360);
    jogs(&mut page, "X+", "1", "0");
    assert_eq!(page.text("said"), "The feed of a jog is a number above 0.");
    // Hold cancels a jog, and the page then drives no longer.
    jogs(&mut page, "X+", "10", "10");
    page.waits(&is_state("Jog"));
    page.presses("hold");
    page.waits(&is_state("Idle"));
    let mut sender = Sender::tcp(&served);
    let at = sender.place();
    assert!(at[0] >= 1.0 && at[0] < 11.0 && at[1..] == [-10.0, -0.1], "{at:?}");
    page.waits("document.getElementById('right').textContent.startsWith('Another sender drives.')");
    assert_eq!(page.value("document.querySelectorAll('[data-jog]:enabled').length"), 0);
    // A jog changes no mode.
    assert!(sender.ask("$G")[0].contains(" G21 G90 "));
    assert_eq!(page.console, Vec::<Value>::new());
    assert_eq!(served.interrupt().0, 0);
}
