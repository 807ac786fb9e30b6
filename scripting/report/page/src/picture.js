// The view as a picture file: the drawing with legends, scale bar, axes and pin, as in the page.

/** Returns the colours of a CSS gradient in order. */
function stops_of(background) {
  return background.match(/rgba?\([^)]*\)/g) ?? [];
}

function is_visible(element) {
  return element.getClientRects().length > 0 && getComputedStyle(element).visibility !== "hidden";
}

function draw_box(context, element, place) {
  const style = getComputedStyle(element);
  const box = place(element.getBoundingClientRect());
  const radius = parseFloat(style.borderTopLeftRadius) * (style.borderTopLeftRadius.endsWith("%") ? box.width / 100 : 1) || 0;
  context.beginPath();
  context.roundRect(box.x, box.y, box.width, box.height, Math.min(radius, box.width / 2));
  const stops = stops_of(style.backgroundImage);
  if (stops.length > 1) {
    const gradient = context.createLinearGradient(box.x, 0, box.x + box.width, 0);
    stops.forEach((colour, k) => gradient.addColorStop(k / (stops.length - 1), colour));
    context.fillStyle = gradient;
    context.fill();
  } else {
    context.fillStyle = style.backgroundColor;
    context.fill();
  }
  const width = parseFloat(style.borderBottomWidth);
  if (width > 0) {
    context.strokeStyle = style.borderBottomColor;
    context.lineWidth = width;
    context.stroke();
  }
}

function draw_text(context, node, place) {
  const range = document.createRange();
  range.selectNodeContents(node);
  const style = getComputedStyle(node.parentElement);
  context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  context.fillStyle = style.color;
  context.textBaseline = "middle";
  const lines = [...range.getClientRects()];
  // Texts of several lines (long names) are rare here; the whole text is drawn in the first line.
  if (lines.length && node.textContent.trim()) {
    const box = place(lines[0]);
    context.fillText(node.textContent.trim(), box.x, box.y + box.height / 2);
  }
}

function draw_svg(context, svg, place) {
  const box = place(svg.getBoundingClientRect());
  const size = box.width / svg.viewBox.baseVal.width;
  const x_of = (x) => box.x + (x - svg.viewBox.baseVal.x) * size, y_of = (y) => box.y + (y - svg.viewBox.baseVal.y) * size;
  for (const part of svg.children) {
    const number = (name) => Number(part.getAttribute(name));
    if (part.tagName === "line") {
      context.strokeStyle = part.getAttribute("stroke");
      context.lineWidth = number("stroke-width") * size;
      context.beginPath();
      context.moveTo(x_of(number("x1")), y_of(number("y1")));
      context.lineTo(x_of(number("x2")), y_of(number("y2")));
      context.stroke();
    } else {
      context.font = "600 11px system-ui, sans-serif";
      context.fillStyle = part.getAttribute("fill");
      context.textAlign = "center";
      context.fillText(part.textContent, x_of(number("x")), y_of(number("y")));
      context.textAlign = "left";
    }
  }
}

function draw_element(context, element, place) {
  if (!is_visible(element)) return;
  if (element.tagName === "svg") return draw_svg(context, element, place);
  draw_box(context, element, place);
  for (const child of element.childNodes) {
    if (child.nodeType === Node.TEXT_NODE) draw_text(context, child, place);
    else draw_element(context, child, place);
  }
}

/** Returns a promise of a PNG (a Blob) of the drawing in `canvas` with these elements over it, at the resolution of the canvas. */
export function picture_with(canvas, elements) {
  const whole = canvas.getBoundingClientRect();
  const result = document.createElement("canvas");
  result.width = canvas.width;
  result.height = canvas.height;
  const context = result.getContext("2d");
  context.drawImage(canvas, 0, 0);
  context.scale(canvas.width / whole.width, canvas.height / whole.height);
  const place = (box) => ({ x: box.x - whole.x, y: box.y - whole.y, width: box.width, height: box.height });
  for (const element of elements) draw_element(context, element, place);
  return new Promise((resolve) => result.toBlob(resolve, "image/png"));
}
