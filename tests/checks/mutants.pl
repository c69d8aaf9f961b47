#!/usr/bin/perl
# Tests of the tests: puts faults into a copy of the sources, one at a time, and
# runs the suites and checks until one fails.
#
#   make mutants                        the faults of tests/data/mutants.txt
#   make mutants ARGS=WORD              those of its lines with this word
#   make mutants ARGS=--check           each fault of it stands exactly once
#   make mutants ARGS='--random SEED COUNT [ROOM...]'
#
# A line of the list: FUNCTION @@ OLD @@ NEW @@ by KILLER
#   FUNCTION  a function or a table; FILE.c:FUNCTION, where several files have
#             one of this name
#   OLD       a piece of its text, whole words, however it is spaced, that
#             stands there exactly once: the shortest that does is the best
#   NEW       what stands there instead
#   KILLER    the suite or check that notices it; ?: any one
#
# Random faults stand at any line of the rooms: a wrong sign, index, comparison,
# order of arguments or constant, a statement or a reset that is dropped.  One
# seed draws the same ones as long as the sources stay.  A fault that the
# compiler notices, or that leaves the same machine code, is drawn again.  The
# suites nearest to it run first, the quicker ones before the others.  Survivors need a
# reader: some of them change nothing that anybody could notice.
use strict;
use warnings;
use Cwd 'abs_path';

$| = 1;
delete @ENV{qw(MAKEFLAGS MFLAGS MAKELEVEL)}; # what is made below has its own
my %near = (
    base => 'base|terms|tables', model => 'terms|laws|mesh|reference|tables',
    solve => 'newton|multigrid|reference|widths|terms|stress',
    step => 'laws|reference|pure|player', lecture => 'lecture|reference',
    run => 'scenes|options|mesh|past|tables|session',
    scenes => 'scenes|options|session|tables', lesson => 'pages|session|scenes',
    picture => 'layout|show|picture|session',
    play => 'past|player|session|film|scripts');
# From the quickest to the slowest.
my @names = ((map { "test_$_" } qw(layout memory mesh widths base options reference scenes past
                                   picture player multigrid document pure terms show
                                   film newton laws stress pages session)),
             (map { "check_$_.sh" } qw(log homework lines pages lecture faults scripts tables files window)));
for my $suite (map { m{/(?:(test_\w+)\.c|(check_\w+\.sh))$} ? $1 // $2 : () }
               glob 'tests/unit/test_*.c tests/checks/check_*.sh') {
    die "$suite is not among the names of mutants.pl\n"
        unless $suite =~ /sources|bench/ || grep { $_ eq $suite } @names;
}

sub read_file {
    open(my $file, '<', $_[0]) or die "$_[0]: $!\n";
    local $/;
    return scalar <$file>;
}

# The time stays, so that make does not write the program's listings anew.
sub write_file {
    my ($name, $text) = @_;
    my @times = (stat $name)[8, 9];
    open(my $file, '>', $name) or die "$name: $!\n";
    print $file $text;
    close($file) or die "$name: $!\n";
    utime @times, $name;
}

# ---- faults of the list --------------------------------------------------------
# Begin and end of what a name defines in a text; an empty list: nothing.
sub definition {
    my ($text, $name) = @_;
    return () if index($text, $name) < 0;
    # A function may be EACH(name), or KERNEL(name, 1).
    my $head = qr/^(?![\s#\/*}])[^;{}=]*?(?<![\w.>])\Q$name\E\b/m;
    return ($-[0], $+[0]) if $text =~ /$head(?:\)?\s*\([^;{]*|, \d+)\)\s*\{.*?\n\}/ms ||
        $text =~ /$head[^;(){}=]*=\s*\{.*?\n\};/ms; # a function, or a table
    return ();
}

# An expression for a piece of text, however it is spaced.
sub piece {
    my ($old) = @_;
    my ($expression, $last) = ('', '');
    for my $token ($old =~ /\w+|[^\w\s]/g) {
        my $apart = $last =~ /\w$/ && $token =~ /^\w/ ? '\s+' : '\s*';
        $expression .= ($last eq '' ? '' : $apart) . quotemeta($token);
        $last = $token;
    }
    $expression = '(?<!\w)' . $expression if $old =~ /^\w/;
    $expression .= '(?!\w)' if $old =~ /\w$/;
    return qr/$expression/;
}

# Where a fault stands: file, begin, length; or one text, why it does not.
sub find_fault {
    my ($function, $old, $sources) = @_;
    my ($file, $name) = $function =~ /^(?:(\S+):)?(\w+)$/;
    my $expression = piece($old);
    my (@found, $defined);
    for my $source (sort keys %$sources) {
        next if $file && $source !~ m{/\Q$file\E$};
        my ($begin, $end) = definition($sources->{$source}, $name);
        next unless defined $begin;
        $defined = 1;
        my $body = substr($sources->{$source}, $begin, $end - $begin);
        push @found, [$source, $begin + $-[0], $+[0] - $-[0]] while $body =~ /$expression/g;
    }
    return "nothing is called $function" unless $defined;
    return "$function has no '$old' any more" unless @found;
    return "$function has '$old' " . @found . ' times' if @found > 1;
    return @{ $found[0] };
}

# The faults of the lines with this word: file, begin, length, new, text, killer.
sub listed {
    my ($list, $word) = @_;
    my %sources = map { $_ => read_file($_) }
        glob('src/*.[ch] src/*/*.[ch] src/*/*.inc include/*/*.h');
    my ($number, $bad, @faults) = (0, 0);
    for my $line (split(/\n/, read_file($list))) {
        $number++;
        next if $line =~ /^(#.*)?$/ || index($line, $word) < 0;
        my @field = map { s/^\s+|\s+$//gr } split(/ @@(?= |$)/, $line, -1);
        my @where = @field == 4 ? find_fault(@field[0, 1], \%sources) : 'not four fields';
        my $killer = $field[-1] =~ s/^by //r;
        $killer = "test_$killer" if $killer =~ /^\w+$/;
        push @faults, [@where, $field[2], $line, $killer];
        next if @where > 1;
        print "$list:$number: $where[0]: say what it is called now, or delete the line\n";
        $bad = 1;
    }
    exit 1 if $bad;
    return @faults;
}

# ---- random faults ---------------------------------------------------------------
# Comments and strings as blanks of the same length.
sub mask {
    my ($text) = @_;
    $text =~ s{(/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')}
              {my ($part, $blank) = ($1, substr($1, 0, 1) eq '/' ? ' ' : "\x01");
               $part =~ s/[^\n]/$blank/gr}gse;
    return $text;
}

my %other = ('<' => '<=', '<=' => '<', '>' => '>=', '>=' => '>', '==' => '!=',
             '!=' => '==', '&&' => '||', '||' => '&&', '+' => '-', '-' => '+',
             '+=' => '-=', '-=' => '+=');
my $simple = qr/[\w.\[\]&*]+(?:->[\w.\[\]]+)*/;

# The faults that a masked line can have: kind, column, length, new text.
sub faults_of {
    my ($line, $whole) = @_;
    my @found;
    my $add = sub { push @found, [$_[0], $-[1], $+[1] - $-[1], $_[1]] };
    my $declares = $line =~
        /^\s+(?:static |const |struct |unsigned )*\w+ \**\w+(?:\[[^\]]*\])+(?:[;,]| =)/;
    $add->('sign', $other{$1}) while $line =~ /(?<=[\w)\]]) ([-+]=?) (?=[\w(&*])/g;
    $add->('sign', '') while $line =~ /(?:[=(,?:*\/] ?|return )(-)(?=[A-Za-z_(])/g;
    $add->('comparison', $other{$1}) while $line =~ / (<=?|>=?|==|!=|&&|\|\|)(?: |$)/g;
    while (!$declares && $line =~ /(?<=[\w\])])\[([^\[\]]+)\]/g) {
        my ($old, $column) = ($1, 0 + $-[1]);
        push @found, ['index', $column, length $old,
            $old eq '0' ? 1 : $old =~ /^(.*) [-+] 1$/ ? $1 : "$old + 1"];
    }
    while ($line =~ /[(,] ?($simple, $simple)(?=[,)])/g) {
        my ($first, $second) = split(/, /, $1);
        $add->('order', "$second, $first") if $first ne $second;
        pos($line) = $+[1] - length $second;
    }
    $add->('constant', $1 eq '0' ? 1 : $1 eq '1' ? 2 : "($1 * 1.5)")
        while !$declares && $line =~ /(?<![\w.'])(\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w.])/g;
    return @found unless $whole &&
        $line =~ /^\s++((?!return|break|continue|goto|case|default|static|const|else)[^;{}]+;)\s*$/;
    my ($statement, $column) = ($1, 0 + $-[1]);
    my $kind = $statement =~ / = (?:0|false|NULL|-1);|^memset/ ? 'reset' : 'dropped';
    push @found, [$kind, $column, length $statement, ';']
        if $line !~ /^\s++(?:unsigned |struct )?\w+ \**\w+(?:\[.*\])?(?:;| = |, )/;
    return @found;
}

# Lines that can have a fault: file, number, begin in the text, faults.
sub lines_of {
    my ($text, @rooms) = @_;
    my @lines;
    for my $file (map { $_ eq 'lecture' ? 'src/lecture.c' : sort glob("src/$_/*.c") } @rooms) {
        next if $file =~ /_web\.c$/;
        my $masked = mask($text->{$file} = read_file($file));
        my ($number, $at, $inside, $before) = (0, 0, 0, '');
        for my $line (split /\n/, $masked) {
            $number++;
            $inside = 1 if $line =~ /^(\{|.*= \{$)/;
            my @faults = $inside && $line =~ /^ {4}/
                ? faults_of($line, $before =~ /[;{})]\s*$|^\s*$|:\s*$/) : ();
            push @lines, [$file, $number, $at, \@faults] if @faults;
            $inside = 0 if $line =~ /^\}/;
            $before = $line if $line =~ /\S/;
            $at += length($line) + 1;
        }
    }
    return @lines;
}

# ---- one fault after the other -----------------------------------------------------
# Whether a suite or check passes; a check may fail by chance once.
sub passes {
    my ($suite, $again) = @_;
    my $run = $suite =~ /\.sh$/ ? "sh tests/checks/$suite" : "build/release/tests/unit/$suite";
    return system('ulimit -S -t 60; ulimit -c 0; CMOCKA_TEST_ABORT=1 ' .
        "exec timeout -k 5 3600 $run >log 2>&1 </dev/null") == 0 ||
        ($suite =~ /\.sh$/ && !$again && passes($suite, 1));
}

sub build {
    return system('make -s build/elasto build/lecture ' . join(' ',
        map { "build/release/tests/unit/$_" } grep !/\.sh$/, @_) . ' >log 2>&1') == 0;
}

# The first suite that fails, or nothing.
sub killer {
    my ($room, $killer) = @_;
    my $near = qr/^(?:test|check)_(?:$near{$room})\b/;
    my @parts = $killer eq '?' ? ([grep /$near/, @names], [grep !/$near/, @names]) : [$killer];
    for my $part (@parts) {
        build(@$part) or return 'make';
        passes($_) or return $_ for @$part;
    }
    return '';
}

my %right; # suites that pass without a fault: those that found one are tried

# Its killer, '' for none; undef: it is no fault.
sub try_fault {
    my ($file, $begin, $length, $new, $killer) = @_;
    my ($room) = $file =~ m{^(?:src|include)/(\w+)/};
    $room = 'lecture' unless $room && $near{$room};
    my ($object) = $file =~ m{^src/(.*)\.c$} ? "build/release/$1.o" : 'none';
    my $again = $object =~ s{/\w+/(?=\w+\.o)}{/narrow/}r; # test_widths has it, too
    my $text = read_file($file);
    my $wrong = $text;
    substr($wrong, $begin, $length) = $new;
    rename $object, 'object';
    write_file($file, $wrong);
    unlink $again;
    utime undef, undef, $file if $object eq 'none'; # others include it
    my $fault = $object eq 'none' || (system("make -s $object >log 2>&1") == 0 &&
        read_file('log') !~ /warning:/ &&
        system("strip -g -o a object && strip -g -o b $object && cmp -s a b") != 0);
    my $found = $fault ? killer($room, $killer) : undef;
    write_file($file, $text);
    utime undef, undef, $file if $object eq 'none';
    unlink $again;
    rename 'object', $object;
    utime undef, undef, $object; # what was linked with the fault is older
    unlink 'build/release/libelasto.a', 'build/release/lecture';
    if ($found && $found ne 'make' && !$right{$found}++) {
        build($found) && passes($found) or die "$found fails without a fault\n", `tail -n 20 log`;
    }
    return $found;
}

my ($how, $seed, $count, @rooms) = (@ARGV, '');
my @faults = $how eq '--random' ? () : listed('tests/data/mutants.txt', $how =~ s/^(?:--)?check$//r);
exit 0 if $how =~ /^(?:--)?check$/;
die "no fault contains '$how'\n" unless @faults || $how eq '--random';

my $tree = abs_path('.') . "/build/mutants.$$";
mkdir $tree or die "$tree: $!\n";
END { system('rm', '-rf', $tree) if $tree }
$SIG{INT} = $SIG{TERM} = $SIG{HUP} = sub { exit 1 };
setpriority(0, 0, 15);
system("mkdir $tree/build; cp -pR Makefile README.md include src tests $tree && " .
       "cp -pR build/*.mk build/release $tree/build") == 0 or die;
chdir $tree or die;
my (%drawn, %killed, @survivors);
sub report {
    my ($file, $killer, $text) = @_;
    my $room = $file =~ m{/(\w+)/} ? $1 : 'lecture';
    $drawn{$room}++;
    $killed{$room} += $killer ne '';
    push @survivors, $text if $killer eq '';
    print $killer eq '' ? "SURVIVED: $text\n" : "killed by $killer: $text\n";
}
for my $fault (@faults) {
    my ($file, $begin, $length, $new, $text, $killer) = @$fault;
    report($file, try_fault($file, $begin, $length, $new, $killer) // '', $text);
}
if ($how eq '--random') {
    my %text;
    @rooms = grep { $_ && $near{$_} } @rooms;
    my @lines = lines_of(\%text, @rooms ? @rooms : sort keys %near);
    srand($seed);
    while ($count > 0) {
        my ($file, $number, $at, $kinds) = @{ $lines[rand @lines] };
        my ($kind, $column, $length, $new) = @{ $kinds->[rand @$kinds] };
        my $killer = try_fault($file, $at + $column, $length, $new, '?') // next;
        my $old = substr($text{$file}, $at + $column, $length);
        report($file, $killer, "$file:$number $kind: $old -> $new");
        $count--;
    }
}
my ($all, $dead) = (0, 0);
for my $room (sort keys %drawn) {
    printf "%-8s %3d of %3d, %3.0f %%\n", $room, $killed{$room}, $drawn{$room},
        100 * $killed{$room} / $drawn{$room};
    $all += $drawn{$room};
    $dead += $killed{$room};
}
printf "all      %3d of %3d, %3.0f %%\n", $dead, $all, 100 * $dead / $all;
print map { "survived: $_\n" } @survivors;
exit(@survivors && $how ne '--random');
