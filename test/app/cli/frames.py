# SPDX-License-Identifier: GPL-3.0-or-later
"""frames.py MOVIE RATE PICTURE...: an animated PNG is well formed (checksums, numbers, sizes), its pictures stay 1 / RATE s, and
they are, pixel by pixel, the PNG pictures named; exits with 1 and the reason if not."""
import struct
import sys
import zlib


def chunks(path):
    data = open(path, 'rb').read()
    assert data[:8] == b'\x89PNG\r\n\x1a\n', 'no PNG'
    at = 8
    while at < len(data):
        n, name = struct.unpack('>I4s', data[at:at + 8])
        body = data[at + 8:at + 8 + n]
        assert struct.unpack('>I', data[at + 8 + n:at + 12 + n])[0] == zlib.crc32(name + body), f'checksum of {name}'
        yield name.decode(), body
        at += 12 + n


def picture(path):
    head, pixels = None, b''
    for name, body in chunks(path):
        head = body if name == 'IHDR' else head
        pixels += body if name == 'IDAT' else b''
    return head, zlib.decompress(pixels)


movie, rate, files = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
head, count, numbers, frames, last = None, None, [], [], None
for name, body in chunks(movie):
    last = name
    if name == 'IHDR':
        head = body
    elif name == 'acTL':
        count = struct.unpack('>II', body)
        assert not frames, 'acTL comes first'
    elif name == 'fcTL':
        control = struct.unpack('>IIIIIHHBB', body)
        numbers.append(control[0])
        frames.append(b'')
        assert control[1:5] == struct.unpack('>II', head[:8]) + (0, 0), 'a frame covers the sheet'
        assert abs(control[5] / control[6] * rate - 1) < 1e-3, f'{control[5]}/{control[6]} s'
    elif name == 'IDAT':
        assert len(frames) == 1, 'IDAT is of the first frame'
        frames[-1] += body
    elif name == 'fdAT':
        assert len(frames) > 1, 'fdAT is of later frames'
        numbers.append(struct.unpack('>I', body[:4])[0])
        frames[-1] += body[4:]
assert last == 'IEND' and numbers == list(range(len(numbers))), 'numbers'
assert count == (len(files), 0) and len(frames) == len(files), f'{len(frames)} frames, {len(files)} pictures'
width, height = struct.unpack('>II', head[:8])
for frame, path in zip(frames, files):
    pixels = zlib.decompress(frame)
    assert len(pixels) == height * (1 + 3 * width), 'a frame has all its pixels'
    if path != '-':
        assert picture(path) == (head, pixels), f'{path} is another picture'
if '-' in files:
    assert len(set(frames)) == len(frames), 'all frames differ'
