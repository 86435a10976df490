## SPDX-License-Identifier: MIT
## Writes tests/golden/curves/octave_nurbs.txt: edits as the Octave NURBS toolbox (octave-nurbs 1.4.3)
## carries them out, control points and knots; and surfaces as it makes them, by their values. An oracle that shares neither code nor algorithm with
## ours: nrbkntins is A5.4, nrbdegelev A5.9. nrbdegelev moves curves that have a double knot from
## degree 4 on, by up to 0.08 here as its own nrbeval shows; those are left out. Needs octave and
## octave-nurbs; tests need only the file.
##
##     octave --no-gui tools/make_octave_references.m > tests/golden/curves/octave_nurbs.txt
##
## Records: edit NAME ARGUMENTS, then degree, and of the curve before and after: knots, x, y, weights
## (x and y not weighted), a line each. shape NAME ARGUMENTS, then degree and curve of each operand,
## then 25 lines `at u v x y z`.
pkg load nurbs
1;
function numbers(what, x)
  printf("%s", what);
  printf(" %.17g", x);
  printf("\n");
end
function curve(c)
  numbers("knots", c.knots);
  numbers("x", c.coefs(1, :) ./ c.coefs(4, :));
  numbers("y", c.coefs(2, :) ./ c.coefs(4, :));
  numbers("weights", c.coefs(4, :));
end
function edit(name, arguments, before, after)
  numbers(["edit " name], arguments);
  numbers("degree", before.order - 1);
  curve(before);
  curve(after);
end

printf("# Made by tools/make_octave_references.m; its head explains the format.\n");
for p = 1:6
  inner = [0.25, 0.4, 0.4, 0.75];
  if p == 1
    inner = [0.25, 0.4, 0.75];
  end
  knots = [zeros(1, p + 1), inner, ones(1, p + 1)];
  n = numel(knots) - p - 1;
  i = 1:n;
  weights = 1 + mod(3 * i, 5) / 4;
  if mod(p, 2) == 1
    weights = ones(1, n);
  end
  x = mod(7 * i, 11) / 8 - 0.5;
  y = mod(5 * i + p, 9) / 4;
  c = nrbmak([x .* weights; y .* weights; zeros(1, n); weights], knots);
  more = [0.1, 0.5, 0.6];
  if p > 2
    more = [0.1, 0.4, 0.5, 0.5, 0.6];
  end
  edit("refine", more, c, nrbkntins(c, more));
  for t = [1, 3]
    raised = nrbdegelev(c, t);
    u = linspace(0, 1, 101);
    if max(max(abs(nrbeval(c, u) - nrbeval(raised, u)))) < 1e-12
      edit("elevate_degree", t, c, raised);
    end
  end
  edit("reverse", [], c, nrbreverse(c));
end

function shape(name, arguments, operands, surface)
  numbers(["shape " name], arguments);
  for i = 1:numel(operands)
    numbers("degree", operands{i}.order - 1);
    curve(operands{i});
  end
  for u = linspace(0, 1, 5)
    for v = linspace(0, 1, 5)
      numbers("at", [u, v, nrbeval(surface, {u, v})']);
    end
  end
end
## Points [x; y] with weights, clamped, over [0, 1].
function c = made(x, y, w, inner)
  p = numel(x) - numel(inner) - 1;
  c = nrbmak([x .* w; y .* w; 0 * w; w], [zeros(1, p + 1), inner, ones(1, p + 1)]);
end
a = made([0, 1, 3, 4], [0, 1, -1, 0], [1, 1, 1, 1], []);
b = made([0, 1, 2, 3, 4], [3, 4, 2, 5, 3], [1, 2, 0.5, 1.5, 1], [0.25, 0.5]);
shape("ruled", [], {a, b}, nrbruled(a, b));
shape("ruled", [], {b, a}, nrbruled(b, a));

profile = made([2, 3, 1, 1.5], [0, 1, 2, 4], [1, 0.5, 2, 1], 0.5);
upright = profile;
upright.coefs(3, :) = profile.coefs(2, :);
upright.coefs(2, :) = 0;
for turn = [0.25, 0.5, 1]
  around = nrbrevolve(upright, [0, 0, 0], [0, 0, 1], 2 * pi * turn);
  shape("revolved", turn, {profile}, around);
end

left = made([0, -1, 0], [0, 1, 3], [1, 0.5, 1], []);
right = made([4, 5, 3, 4], [0, 1, 2, 3], [1, 1, 1, 1], []);
shape("coons", [], {a, b, left, right}, nrbcoons(a, b, left, right));
