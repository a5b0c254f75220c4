/* Draws every figure that has data with uPlot, in place of its SVG: drag to zoom, double click to reset, values at the pointer, keyboard control. If this fails, the
   SVG is shown. No request is made. */
(() => {
  "use strict";
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const FONT = "12.5px system-ui, sans-serif";
  const MINUS = "\u2212", DASH = "\u2013";
  const GRID = ["#DFE3E7", "#333A42"], QUIET = ["#565F69", "#A6AFB9"], TEXT = ["#1B2026", "#E6E9EC"];
  const of = pair => pair[dark.matches ? 1 : 0];

  const element = (name, className, parent) => {
    const made = document.createElement(name);
    if (className) made.className = className;
    if (parent) parent.append(made);
    return made;
  };

  /* Text with its subscripts: i_d. */
  const words = (parent, text) => {
    parent.replaceChildren();
    text.split(/\b(?=omega_|[a-zA-Z]_)/).forEach(part => {
      const symbol = /^(omega|[a-zA-Z])_([a-zA-Z]+)(.*)$/s.exec(part);
      if (!symbol) return parent.append(part);
      const letter = symbol[1] === "omega" ? "\u03c9" : symbol[1];
      if (letter === "F") parent.append(letter); else element("i", "", parent).textContent = letter;
      element("sub", "", parent).textContent = symbol[2];
      parent.append(symbol[3]);
    });
    return parent;
  };

  const column = ({ exponent, steps }) => {
    let sum = 0;
    const scale = Math.pow(10, Math.abs(exponent));
    return steps.map(step => step === null ? null : (sum += step, exponent < 0 ? sum / scale : sum * scale));
  };

  const fixed = (value, decimals) => value.toFixed(Math.min(Math.max(decimals, 0), 12)).replace(/^-(?=.*[1-9])/, MINUS).replace(/^-/, "");
  const raised = n => String(n).replace(/[-0-9]/g, c => c === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[c]);
  const power = logarithm => {
    const whole = Math.floor(logarithm + 1e-9);
    return Math.pow(10, logarithm - whole).toFixed(1) + "\u00b710" + raised(whole);
  };
  const ROUND = Array.from({ length: 30 }, (_, k) => k - 15).flatMap(e => [1, 2, 5].map(digit => Number(digit + "e" + e)));
  const WHOLE = ROUND.filter(step => step >= 1), DECADES = [1, 2, 3, 5, 10, 20, 50, 100];
  const ticks = (u, splits, axis, space, step) => splits.map(v => v === null ? null : fixed(v, Math.ceil(-Math.log10(step) - 1e-9)));

  const stroke = (series, opacity) => () => of(series.ink) + Math.round(255 * opacity).toString(16).padStart(2, "0");

  /* The columns of a panel, and how uPlot draws each: bands take two of their own, below the curves. */
  const drawn = (panel, x) => {
    const columns = [x], series = [{}], bands = [], shown = [];
    if (panel.kind === "decades") panel.series.forEach(one => {
      bands.push({ series: [columns.length + 1, columns.length], fill: stroke(one, 0.16) });
      one.about.forEach(edge => { columns.push(column(edge)); series.push({ width: 0, points: { show: false } }); });
    });
    panel.series.forEach(one => {
      shown.push(columns.length);
      columns.push(column(one.values));
      const points = panel.kind === "plane";
      series.push({
        stroke: stroke(one, one.opacity), width: one.width, dash: one.dash, spanGaps: false,
        paths: points || panel.kind === "bars" ? () => null : undefined,
        points: points ? { show: true, size: 9, width: 0, fill: stroke(one, one.opacity) } : { show: false },
      });
    });
    return { columns, series, bands, shown };
  };

  /* The point nearest to the pointer in the plane. */
  const nearest = u => {
    let best = null, least = Infinity;
    u.data[0].forEach((x, k) => {
      const distance = Math.hypot(u.valToPos(x, "x") - u.cursor.left, u.valToPos(u.data[1][k], "y") - u.cursor.top);
      if (distance < least) [best, least] = [k, distance];
    });
    return best;
  };

  const line = (u, from, to, color, width) => {
    /* uPlot remembers what it set. */
    u.ctx.save();
    u.ctx.strokeStyle = color; u.ctx.lineWidth = width * devicePixelRatio; u.ctx.setLineDash([]);
    u.ctx.beginPath(); u.ctx.moveTo(...from); u.ctx.lineTo(...to); u.ctx.stroke();
    u.ctx.restore();
  };

  /* The zero line, below the curves. */
  const zero = panel => u => {
    const { left, top, width, height } = u.bbox, y = u.valToPos(0, "y", true);
    if ((panel.kind === "bars" || panel.name.startsWith("measured")) && y > top && y < top + height) line(u, [left, y], [left + width, y], of(TEXT), 1);
  };

  /* Windows and rows that were left out, below the curves; a single row is still visible. */
  const SHADES = { true: ["#176F38", "#5FD083", 0.14], false: ["#565F69", "#A6AFB9", 0.28] };
  const spans = data => u => {
    const { left, top, width, height } = u.bbox;
    u.ctx.save();
    u.ctx.beginPath(); u.ctx.rect(left, top, width, height); u.ctx.clip();
    (data.spans || []).forEach(({ is_window, ends }) => {
      const [from, to] = ends.map(t => Math.min(Math.max(u.valToPos(t, "x", true), left - 9), left + width + 9));
      if (to < left || from > left + width) return;
      const shade = SHADES[is_window];
      u.ctx.fillStyle = of(shade); u.ctx.globalAlpha = shade[2];
      u.ctx.fillRect(from, top, Math.max(to - from, 2 * devicePixelRatio), height);
    });
    u.ctx.restore();
  };

  /* Drawn by hand: error bars with their markers, and the numbers of points. */
  const extras = (panel, descriptions) => u => {
    const { left, top, width, height } = u.bbox, ratio = devicePixelRatio, ctx = u.ctx;
    const at = (value, scale) => u.valToPos(value, scale, true);
    ctx.save();
    ctx.beginPath(); ctx.rect(left, top, width, height); ctx.clip();
    if (panel.kind === "bars") panel.series.forEach((one, s) => {
      const color = of(one.ink), bars = column(one.about[0]), r = 4 * ratio;
      u.data[0].forEach((x, k) => {
        const value = u.data[s + 1][k], px = at(x + (s ? 0.15 : -0.15), "x");
        if (value === null || bars[k] === null) return;
        line(u, [px, at(value - bars[k], "y")], [px, at(value + bars[k], "y")], color, 1.5);
        ctx.fillStyle = color; ctx.beginPath();
        if (s) ctx.rect(px - r, at(value, "y") - r, 2 * r, 2 * r); else ctx.arc(px, at(value, "y"), r, 0, 2 * Math.PI);
        ctx.fill();
      });
    });
    if (panel.kind === "plane") {
      ctx.fillStyle = of(TEXT); ctx.textAlign = "center"; ctx.textBaseline = "middle";
      ctx.font = FONT.replace("12.5", 12.5 * ratio);
      /* As drawing/labels.rs: no label overprints another one or a point. */
      const points = u.data[0].map((x, k) => [at(x, "x"), at(u.data[1][k], "y")]), m = 5 * ratio;
      const boxes = points.map(([x, y]) => [x - m, y - m, x + m, y + m]);
      points.forEach(([x, y], k) => {
        const name = descriptions[k].match(/\d+/)[0], half = 0.5 * ctx.measureText(name).width + 3 * ratio, tall = 7 * ratio;
        const aside = half + m, above = m + 2 * ratio + tall, far = aside + 2 * half + 4 * ratio;
        for (const [dx, dy] of [[0, -above], [aside, 0], [-aside, 0], [0, above], [far, 0], [-far, 0], [aside, -above], [-aside, -above]]) {
          const box = [x + dx - half, y + dy - tall, x + dx + half, y + dy + tall];
          if (box[0] < left || box[1] < top || box[2] > left + width || box[3] > top + height) continue;
          if (boxes.some(other => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1])) continue;
          boxes.push(box);
          ctx.fillText(name, x + dx, y + dy);
          break;
        }
      });
    }
    ctx.restore();
  };

  /* A few residuals far from all others do not stretch their axis: as Axis::robust. */
  const robust = panel => {
    const sorted = Float64Array.from(panel.series.flatMap(one => column(one.values).filter(v => v !== null))).sort();
    const few = Math.floor(0.01 * sorted.length), low = sorted[few], high = sorted[sorted.length - 1 - few];
    return high > low ? [low - 0.5 * (high - low), high + 0.5 * (high - low)] : [-Infinity, Infinity];
  };

  const range = panel => (u, low, high) => {
    const { kind } = panel;
    if (low === null) return [0, 1];
    if (panel.name.startsWith("measured")) {
      panel.reach = panel.reach || robust(panel);
      const [from, to] = [Math.max(low, panel.reach[0]), Math.min(high, panel.reach[1])];
      if (to > from) [low, high] = [from, to];
    }
    if (kind === "decades") return [Math.floor(low), Math.max(Math.ceil(high), Math.floor(low) + 1)];
    const margin = high > low ? 0.06 * (high - low) : 0.5 * Math.max(Math.abs(high), 1e-3);
    return [low - margin, high + margin];
  };

  const draw = figure => {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const x = column(data.x.values), svg = figure.querySelector("svg");
    if (x.length < 2 && data.panels[0].kind !== "plane" && data.panels[0].kind !== "bars" || !x.length) return;
    const plate = document.createElement("div");
    plate.className = data.descriptions ? "plot described" : "plot";
    plate.setAttribute("role", "group");
    plate.tabIndex = 0;
    plate.setAttribute("aria-label", svg.getAttribute("aria-label") + ". Left and right arrow: values; plus and minus: zoom; Escape: reset the zoom.");
    const bar = element("p", "tools", plate);
    const along = element("output", "", bar);
    figure.insertBefore(plate, svg);
    const plots = [];
    const decimals = one => Math.max(0, -one.values.exponent);

    const zoom = (low, high) => plots.forEach(u => u.setScale("x", { min: low, max: high }));
    const back = () => plots.forEach(u => u.batch(() => {
      const [low, high] = u.fullRange("x");
      u.setScale("x", { min: low, max: high });
      const y = u.fullRange("y");
      if (y) u.setScale("y", { min: y[0], max: y[1] });
    }));
    const closer = factor => {
      const u = plots[0], { min, max } = u.scales.x, k = u.cursor.idx;
      const middle = k === null || k === undefined || x[k] < min || x[k] > max ? 0.5 * (min + max) : x[k];
      const [low, high] = u.fullRange("x");
      const [from, to] = [Math.max(low, middle - (middle - min) * factor), Math.min(high, middle + (max - middle) * factor)];
      if (to > from) zoom(from, to);
    };
    /* uPlot needs a pointer position, so the keyboard moves one. */
    const step = by => {
      const u = plots[0], { min, max } = u.scales.x;
      const inside = x.map((v, k) => k).filter(k => x[k] >= min && x[k] <= max);
      if (!inside.length) return;
      const at = inside.indexOf(u.cursor.idx), many = Math.max(1, Math.round(inside.length / 200));
      const k = inside[at < 0 ? 0 : Math.min(Math.max(at + by * many, 0), inside.length - 1)];
      const y = u.data[u.shown[0]][k];
      u.setCursor({ left: u.valToPos(x[k], "x"), top: u.valToPos(y === null ? 0 : y, "y") });
    };
    const tools = element("span", "", bar);
    [["PNG", "Save this figure as PNG", () => savePicture(plate, plots)], ["+", "Zoom in", () => closer(0.5)], [MINUS, "Zoom out", () => closer(2)], ["reset", "Reset the zoom", back]].forEach(([text, title, act]) => {
      const button = element("button", "", tools);
      button.type = "button"; button.textContent = text; button.title = title;
      button.setAttribute("aria-label", title);
      button.addEventListener("click", act);
    });
    plate.addEventListener("keydown", event => {
      const act = { ArrowLeft: () => step(-1), ArrowRight: () => step(1), "+": () => closer(0.5), "-": () => closer(2), Escape: back }[event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act();
      along.setAttribute("aria-live", "polite");
    });

    /* The index of the x value at the pointer. The pointer is over one panel; the others may not be updated yet. */
    const pointed = () => plots.map(u => u.cursor.left < 0 ? null : u.panel.kind === "plane" ? nearest(u) : u.cursor.idx).find(k => k !== null && k !== undefined);
    const spanAt = t => (data.spans || []).filter(({ ends }) => t >= ends[0] && t <= ends[1]).map(({ text }) => " \u00b7 " + text).join("");
    const tell = () => {
      const k = pointed(), none = k === undefined;
      words(along, none ? "Drag to zoom, double click to reset"
        : data.descriptions.length ? data.descriptions[k] : data.x.name + " " + fixed(x[k], decimals(data.x)) + (data.x.unit && " " + data.x.unit) + spanAt(x[k]));
      plots.forEach(u => u.values.forEach((value, s) => {
        const y = none ? null : u.data[u.shown[s]][k], one = u.panel.series[s];
        value.textContent = none ? "" : y === null || y === undefined ? DASH
          : u.panel.kind === "decades" ? power(y)
          : fixed(y, decimals(one)) + (one.about && u.panel.kind === "bars" ? " \u00b1 " + fixed(column(one.about[0])[k] || 0, decimals(one)) : "");
      }));
    };

    const key = "fluxfit-" + Array.prototype.indexOf.call(document.querySelectorAll("figure"), figure);
    data.descriptions = data.descriptions || [];
    data.panels.forEach((panel, number) => {
      const head = element("p", "keys", plate), last = number === data.panels.length - 1;
      words(element("span", "", head), panel.name);
      const values = panel.kind === "plane" ? [] : panel.series.map(one => {
        const name = element("span", "key", head), mark = element("i", "", name);
        mark.style.setProperty("--light", one.ink[0]);
        mark.style.setProperty("--dark", one.ink[1]);
        mark.style.borderTopWidth = Math.max(2, one.width) + "px";
        mark.style.opacity = one.opacity;
        if (one.dash) mark.style.borderTopStyle = one.dash[0] > 2 ? "dashed" : "dotted";
        words(element("span", "", name), one.name);
        return element("b", "", name);
      });
      const { columns, series, bands, shown } = drawn(panel, x);
      const plane = panel.kind === "plane";
      const options = {
        width: plate.clientWidth || 320, height: heightOf(data.panels, number), padding: [8, 14, 0, 0], series, bands,
        legend: { show: false },
        cursor: {
          sync: { key, scales: ["x", null] }, drag: { x: true, y: plane, uni: plane ? 12 : undefined, setScale: true },
          y: plane,
          points: plane ? { size: 17, width: 2, fill: "transparent" } : { size: 8, show: panel.kind !== "bars" },
          dataIdx: plane ? u => nearest(u) : undefined,
        },
        scales: {
          x: { time: false, range: plane ? (u, low, high) => [low, high] : undefined },
          y: { range: (u, low, high) => panel.kind === "bars" || plane ? [low, high] : range(panel)(u, low, high) },
        },
        axes: [
          { stroke: () => of(QUIET), font: FONT, grid: { stroke: () => of(GRID), width: 1 }, ticks: { show: false }, size: last ? 26 : 6, space: panel.kind === "bars" ? 28 : 60,
            gap: 6,
            incrs: panel.kind === "bars" || panel.kind === "decades" ? WHOLE : ROUND,
            values: last ? ticks : () => [] },
          { stroke: () => of(QUIET), font: FONT, grid: { stroke: () => of(GRID), width: 1 }, ticks: { show: false }, size: 64, space: panel.height < 180 ? 22 : 34, gap: 6,
            incrs: panel.kind === "decades" ? DECADES : ROUND,
            values: panel.kind === "decades" ? (u, splits) => splits.map(v => "10" + raised(v)) : ticks },
        ],
        hooks: {
          drawClear: [spans(data)], drawAxes: [zero(panel)],
          draw: [extras(panel, data.descriptions)],
          setCursor: [tell],
          /* All panels of a figure show the same range of x. */
          setScale: [(u, scale) => {
            if (scale !== "x") return;
            const { min, max } = u.scales.x;
            plots.forEach(other => {
              if (other !== u && (other.scales.x.min !== min || other.scales.x.max !== max)) other.setScale("x", { min, max });
            });
          }],
        },
      };
      const u = new uPlot(options, columns, element("div", "", plate));
      Object.assign(u, { panel, shown, values, fullRange: scale => panel.ranges ? panel.ranges[scale === "x" ? 0 : 1] : scale === "x" ? [x[0], x[x.length - 1]] : null });
      plots.push(u);
      u.over.addEventListener("dblclick", back);
      touch(u);
    });
    words(element("p", "along", plate), data.x.name + (data.x.unit && ", " + data.x.unit));
    figure.classList.add("live");
    plots.forEach((u, k) => u.setSize({ width: plate.clientWidth || 320, height: heightOf(data.panels, k) }));
    back();
    tell();
    new ResizeObserver(() => {
      const width = plate.clientWidth;
      if (width) plots.forEach((u, k) => u.width !== width && u.setSize({ width, height: heightOf(data.panels, k) }));
    }).observe(plate);
    dark.addEventListener("change", () => plots.forEach(u => u.redraw()));
  };

  /* Only the lowest panel has numbers at its x axis; the name of a panel is above it. */
  const heightOf = (panels, k) => panels[k].height - (k === panels.length - 1 ? 26 : 40);

  /* A horizontal touch acts as a pressed mouse; a vertical one scrolls the page. uPlot ignores mouse events without movement. */
  const touch = u => {
    const pass = (target, name, event) => target.dispatchEvent(new MouseEvent(name, {
      clientX: event.clientX, clientY: event.clientY, movementX: 1, button: 0, buttons: 1, bubbles: true, view: window }));
    let pressed = false;
    u.over.addEventListener("pointerdown", event => {
      if (event.pointerType !== "touch" || !event.isPrimary) return;
      pressed = true;
      pass(u.over, "mouseenter", event); pass(u.over, "mousemove", event); pass(u.over, "mousedown", event);
    });
    u.over.addEventListener("pointermove", event => { if (pressed) pass(u.over, "mousemove", event); });
    const end = event => { if (pressed) { pressed = false; pass(document, "mouseup", event); } };
    u.over.addEventListener("pointerup", end);
    u.over.addEventListener("pointercancel", end);
    /* Neither do the mouse events of a tap have movement. */
    u.over.addEventListener("click", event => u.setCursor({ left: event.offsetX, top: event.offsetY }));
  };

  const save = (name, content) => {
    const link = element("a", "", document.body);
    link.href = URL.createObjectURL(content);
    link.download = document.querySelector("h1").textContent.replace(/[^\w.-]+/g, "_") + name;
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };

  /* The panels of a figure below each other, each with its name, on the page's ground. */
  const savePicture = (plate, plots) => {
    const ratio = devicePixelRatio, head = 22 * ratio, sheet = document.createElement("canvas"), names = plate.querySelectorAll(".keys");
    sheet.width = plots[0].ctx.canvas.width;
    sheet.height = plots.reduce((sum, u) => sum + u.ctx.canvas.height + head, 0.5 * head);
    const ctx = sheet.getContext("2d");
    ctx.fillStyle = getComputedStyle(document.documentElement).backgroundColor;
    ctx.fillRect(0, 0, sheet.width, sheet.height);
    ctx.font = FONT.replace("12.5", 12.5 * ratio); ctx.fillStyle = of(TEXT); ctx.textBaseline = "middle";
    let top = 0;
    plots.forEach((u, k) => {
      ctx.fillText(names[k].firstChild.textContent, 6 * ratio, top + 0.5 * head);
      ctx.drawImage(u.ctx.canvas, 0, top + head);
      top += head + u.ctx.canvas.height;
    });
    sheet.toBlob(blob => save(".png", blob));
  };

  /* Fitted and measured values: the rows of the currents, or of the table of operating points. */
  const values = () => {
    const figure = [...document.querySelectorAll("#currents figure, #prediction figure")].find(one => one.querySelector("script"));
    const quoted = text => /[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
    if (figure) {
      const data = JSON.parse(figure.querySelector("script").textContent), names = [data.x.name + ", " + data.x.unit], columns = [column(data.x.values)];
      data.panels.forEach(panel => panel.series.forEach(one => { names.push(panel.name + ": " + one.name); columns.push(column(one.values)); }));
      const rows = columns[0].map((x, k) => columns.map(values => values[k] === null ? "" : String(values[k])).join(","));
      return [names.map(quoted).join(",")].concat(rows).join("\n") + "\n";
    }
    const table = document.querySelector("[data-values] table");
    if (!table) return null;
    const written = cell => [...cell.childNodes].filter(part => part.className !== "key").map(part => part.textContent).join("");
    /* A residual and its half-width are two values. */
    const cells = row => [...row.cells].flatMap(cell => written(cell).split("±").map(value => quoted(value.trim().replaceAll(MINUS, "-")))).join(",");
    return table.dataset.header + "\n" + [...table.tBodies[0].rows].map(cells).join("\n") + "\n";
  };

  const copy = async (text, button) => {
    try { await navigator.clipboard.writeText(text); } catch (error) {
      const area = element("textarea", "", document.body);
      area.value = text; area.select(); document.execCommand("copy"); area.remove();
    }
    const name = button.textContent;
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = name; }, 1500);
  };

  const actions = () => {
    const command = document.querySelector("#reproduce pre"), json = document.querySelector("#document script"), csv = values();
    const bar = document.createElement("p");
    bar.className = "actions";
    const add = (name, act) => {
      const button = element("button", "", bar);
      button.type = "button"; button.textContent = name;
      button.addEventListener("click", () => act(button));
    };
    if (command) add("Copy the command", button => copy(command.textContent, button));
    if (json) add("Save JSON", () => save(".json", new Blob([json.textContent], { type: "application/json" })));
    if (csv) add("Save CSV, fitted and measured", () => save(".csv", new Blob([csv], { type: "text/csv" })));
    document.querySelector("header").append(bar);
  };
  actions();

  document.querySelectorAll("figure").forEach(figure => {
    if (!figure.querySelector("script")) return;
    try { draw(figure); } catch (error) {
      figure.classList.remove("live");
      figure.querySelectorAll(".plot").forEach(plot => plot.remove());
    }
  });
})();
