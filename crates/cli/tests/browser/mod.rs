//! A real browser, steered over its own pipe (Chrome DevTools Protocol, messages end with a zero byte): no driver, no socket
//! and no crate is needed for that.

use std::cell::{Cell, RefCell};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// A browser on a busy computer is slow; what takes longer than this hangs.
const BOUND: Duration = Duration::from_secs(120);

/// Names under which Chromium is installed.
const NAMES: [&str; 6] = [
    "chromium",
    "chromium-browser",
    "google-chrome-stable",
    "google-chrome",
    "chrome",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
];

/// A page of a browser. It ends with this.
pub struct Page {
    program: PathBuf,
    child: Child,
    input: RefCell<ChildStdin>,
    output: Receiver<Value>,
    session: Option<String>,
    asked: Cell<u64>,
    /// What came without being asked for.
    events: RefCell<Vec<Value>>,
    folder: tempfile::TempDir,
}

/// The browser's program: `CHROMIUM`, `CHROME`, or where it is usually found.
fn program() -> PathBuf {
    let named = ["CHROMIUM", "CHROME"].map(std::env::var_os);
    if let Some(named) = named.into_iter().flatten().find(|name| !name.is_empty()) {
        return named.into();
    }
    let folders: Vec<PathBuf> =
        std::env::var_os("PATH").map_or_else(Vec::new, |p| std::env::split_paths(&p).collect());
    let places =
        (NAMES.iter()).flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    let mut places = places.filter(|place| place.is_file());
    places.next().unwrap_or_else(|| {
        panic!(
            "the test of the report needs Chromium, and there is none. Install it (Debian, as root: \
             apt-get install --yes chromium) or say where it is: CHROMIUM=/path/to/chromium"
        )
    })
}

impl Page {
    /// Starts a browser with an empty page.
    pub fn start() -> Page {
        let program = program();
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("saved")).expect("made");
        // The browser reads from its third stream and writes to its fourth.
        let mut command = Command::new("sh");
        command.args([
            "-c",
            "exec \"$0\" \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>&1",
        ]);
        command.arg(&program).args([
            "--headless=new",
            "--remote-debugging-pipe",
            // It only ever sees pages that this test made, and as root it does not start otherwise.
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--no-first-run",
            "--disable-extensions",
            "--disable-background-networking",
            "--force-color-profile=srgb",
        ]);
        command.arg(format!(
            "--user-data-dir={}",
            folder.path().join("profile").display()
        ));
        command.arg("about:blank");
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("sh runs");
        let input = child.stdin.take().expect("a pipe");
        let output = BufReader::new(child.stdout.take().expect("a pipe"));
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            for message in output.split(0).map_while(Result::ok) {
                let value = serde_json::from_slice(&message).expect("JSON");
                if sender.send(value).is_err() {
                    break;
                }
            }
        });
        let mut page = Page {
            program,
            child,
            input: RefCell::new(input),
            output: receiver,
            session: None,
            asked: Cell::new(0),
            events: RefCell::default(),
            folder,
        };
        page.attach();
        page
    }

    fn attach(&mut self) {
        let saved = self.folder.path().join("saved");
        let downloads = json!({"behavior": "allow", "downloadPath": saved, "eventsEnabled": true});
        self.ask("Browser.setDownloadBehavior", downloads);
        let target = self.ask("Target.createTarget", json!({"url": "about:blank"}));
        let attach = json!({"targetId": target["targetId"], "flatten": true});
        let attached = self.ask("Target.attachToTarget", attach);
        self.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log"] {
            self.ask(&format!("{domain}.enable"), json!({}));
        }
    }

    /// Sends a command and waits for its answer.
    pub fn ask(&self, method: &str, parameters: Value) -> Value {
        let id = self.asked.get() + 1;
        self.asked.set(id);
        let mut message = json!({"id": id, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = session.as_str().into();
        }
        let sent = self
            .input
            .borrow_mut()
            .write_all(format!("{message}\0").as_bytes());
        sent.unwrap_or_else(|error| panic!("{} has ended: {error}", self.program.display()));
        let begun = Instant::now();
        loop {
            let answer = self.next(begun, method);
            if answer["id"] == id {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.events.borrow_mut().push(answer);
        }
    }

    fn next(&self, begun: Instant, what: &str) -> Value {
        match self
            .output
            .recv_timeout(BOUND.saturating_sub(begun.elapsed()))
        {
            Ok(message) => message,
            Err(RecvTimeoutError::Timeout) => panic!("no answer in {BOUND:?}: {what}"),
            Err(RecvTimeoutError::Disconnected) => {
                panic!(
                    "{} does not start, or has ended before it answered: {what}",
                    self.program.display()
                )
            }
        }
    }

    /// Waits for something that the browser tells by itself, and takes it.
    fn told(&self, what: &str, is_it: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            let found = self.events.borrow().iter().position(&is_it);
            if let Some(index) = found {
                return self.events.borrow_mut().remove(index);
            }
            let message = self.next(begun, what);
            self.events.borrow_mut().push(message);
        }
    }

    /// Opens a file in a window of a size, as a phone has it or a desktop; on a dark screen or a light one.
    pub fn open(&self, file: &Path, [width, height]: [u32; 2], phone: bool, dark: bool) {
        let metrics =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": phone});
        self.ask("Emulation.setDeviceMetricsOverride", metrics);
        self.ask(
            "Emulation.setTouchEmulationEnabled",
            json!({"enabled": phone}),
        );
        let scheme = if dark { "dark" } else { "light" };
        let features = json!([{"name": "prefers-color-scheme", "value": scheme}]);
        self.ask("Emulation.setEmulatedMedia", json!({"features": features}));
        let file = fs::canonicalize(file).expect("a file");
        let gone = self.ask(
            "Page.navigate",
            json!({"url": format!("file://{}", file.display())}),
        );
        assert!(gone["errorText"].is_null(), "{}", gone["errorText"]);
        self.told("load", |event| event["method"] == "Page.loadEventFired");
    }

    /// The value of an expression in the page; of a promise, what it promises.
    pub fn value(&self, expression: &str) -> Value {
        let asked = json!({"expression": expression, "awaitPromise": true, "returnByValue": true, "userGesture": true});
        let answer = self.ask("Runtime.evaluate", asked);
        let failed = &answer["exceptionDetails"];
        assert!(failed.is_null(), "{expression}: {failed}");
        answer["result"]["value"].clone()
    }

    /// The text that an expression in the page gives.
    pub fn text(&self, expression: &str) -> String {
        let value = self.value(expression);
        value
            .as_str()
            .map_or_else(|| panic!("{expression}: {value}"), str::to_owned)
    }

    /// The number that an expression in the page gives.
    pub fn number(&self, expression: &str) -> f64 {
        let value = self.value(expression);
        value
            .as_f64()
            .unwrap_or_else(|| panic!("{expression}: {value}"))
    }

    /// Waits until a condition holds in the page.
    pub fn wait(&self, condition: &str) {
        let look = format!(
            "new Promise((done) => {{ const look = () => ({condition}) ? done(true) : setTimeout(look, 20); look(); }})"
        );
        self.value(&look);
    }

    /// Clicks in the middle of the first element of a selector.
    pub fn click(&self, selector: &str) {
        let place = self.place(selector, [0.5, 0.5]);
        self.mouse("mousePressed", place);
        self.mouse("mouseReleased", place);
    }

    /// A place in the window, at these shares of an element's width and height. The element is brought into sight, and what
    /// moves is waited for: it stands still for two frames, and nothing lies on it.
    pub fn place(&self, selector: &str, [across, down]: [f64; 2]) -> [f64; 2] {
        let expression = format!(
            "new Promise((done) => {{ let last = ''; const look = () => {{ const e = document.querySelector({selector:?}); \
             e.scrollIntoView({{block: 'center'}}); const b = e.getBoundingClientRect(); \
             const at = [b.x + {across} * b.width, b.y + {down} * b.height], now = at.join(); \
             if (now === last && e.contains(document.elementFromPoint(...at))) done(at); \
             else {{ last = now; requestAnimationFrame(look); }} }}; look(); }})"
        );
        let place = self.value(&expression);
        [0, 1].map(|k| {
            place[k]
                .as_f64()
                .unwrap_or_else(|| panic!("{selector}: {place}"))
        })
    }

    /// An event of the mouse, with its left button.
    pub fn mouse(&self, kind: &str, [x, y]: [f64; 2]) {
        let buttons = u8::from(kind != "mouseReleased");
        let (button, buttons) = match kind {
            "mouseMoved" => ("none", 0),
            _ => ("left", buttons),
        };
        let event = json!({"type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1});
        self.ask("Input.dispatchMouseEvent", event);
    }

    /// Touches a place with a finger and lifts it.
    pub fn tap(&self, [x, y]: [f64; 2]) {
        let touch = json!({"type": "touchStart", "touchPoints": [{"x": x, "y": y}]});
        self.ask("Input.dispatchTouchEvent", touch);
        let lifted = json!({"type": "touchEnd", "touchPoints": []});
        self.ask("Input.dispatchTouchEvent", lifted);
    }

    /// Presses a key by its name.
    pub fn key(&self, key: &str) {
        let (name, code) = match key {
            " " => (" ", 32),
            "Escape" => ("Escape", 27),
            "Home" => ("Home", 36),
            "End" => ("End", 35),
            "ArrowRight" => ("ArrowRight", 39),
            "Tab" => ("Tab", 9),
            _ => panic!("what key is {key}?"),
        };
        for kind in ["keyDown", "keyUp"] {
            let event = json!({"type": kind, "key": name, "windowsVirtualKeyCode": code});
            self.ask("Input.dispatchKeyEvent", event);
        }
    }

    /// Clicks on something that saves a file and returns the file's name and bytes.
    pub fn saved(&self, selector: &str) -> (String, Vec<u8>) {
        self.click(selector);
        let begun = self.told(&format!("{selector} saves"), |e| {
            e["method"] == "Browser.downloadWillBegin"
        });
        let [id, name] = ["guid", "suggestedFilename"].map(|key| begun["params"][key].clone());
        let ended = self.told("the end of a download", |e| {
            let (method, it) = (&e["method"], &e["params"]);
            method == "Browser.downloadProgress" && it["guid"] == id && it["state"] != "inProgress"
        });
        assert_eq!(ended["params"]["state"], "completed", "{name}");
        let name = name.as_str().expect("a name").to_owned();
        let file = self.folder.path().join("saved").join(&name);
        let bytes = fs::read(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        fs::remove_file(file).expect("removed");
        (name, bytes)
    }

    /// Everything that can be used without a name for people who cannot see it.
    pub fn nameless(&self) -> Vec<String> {
        let tree = self.ask("Accessibility.getFullAXTree", json!({}));
        let used = [
            "button",
            "checkbox",
            "combobox",
            "slider",
            "spinbutton",
            "tab",
            "textbox",
            "img",
            "image",
            "DisclosureTriangle",
            "dialog",
        ];
        let nodes = tree["nodes"].as_array().expect("a tree").iter();
        let nodes = nodes.filter(|n| n["ignored"] != true);
        let nodes = nodes.filter(|n| {
            n["role"]["value"]
                .as_str()
                .is_some_and(|r| used.contains(&r))
        });
        let nameless =
            nodes.filter(|n| n["name"]["value"].as_str().unwrap_or("").trim().is_empty());
        nameless.map(Value::to_string).collect()
    }

    /// Errors and warnings that the page or the browser told since the last time.
    pub fn complaints(&self) -> Vec<String> {
        // what was told before this answer has come by then
        self.value("0");
        let complaint = |event: &Value| {
            let it = &event["params"];
            match event["method"].as_str()? {
                "Runtime.exceptionThrown" => Some(it["exceptionDetails"].to_string()),
                "Runtime.consoleAPICalled" => {
                    matches!(it["type"].as_str(), Some("error" | "warning" | "assert"))
                        .then(|| it.to_string())
                }
                "Log.entryAdded" => {
                    matches!(it["entry"]["level"].as_str(), Some("error" | "warning"))
                        .then(|| it.to_string())
                }
                _ => None,
            }
        };
        let events = self.events.take();
        events.iter().filter_map(complaint).collect()
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // The shell became the browser, which ends its own helpers when it is asked to go.
        let close = json!({"id": 0, "method": "Browser.close"});
        let sent = self
            .input
            .borrow_mut()
            .write_all(format!("{close}\0").as_bytes());
        let begun = Instant::now();
        while sent.is_ok() && begun.elapsed() < Duration::from_secs(10) {
            if let Ok(Some(_)) = self.child.try_wait() {
                return;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
